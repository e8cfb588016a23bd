"""What the site adds to the documents: two pages that are made, and links to folders and to the licences led to their pages."""

from __future__ import annotations

import ast
import os
import posixpath
import re
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

PACKAGE = Path(os.environ["GUIDE_PACKAGE"]) / "chta"
LINK = re.compile(r"(\]\()([^)#:]+)((?:#[^)]*)?\))")


def _api() -> str:
    """A page with every public name of the package, in the order of the modules that define them."""
    tree = ast.parse((PACKAGE / "__init__.py").read_text())
    public = next(ast.literal_eval(n.value) for n in tree.body if isinstance(n, ast.Assign) and n.targets[0].id == "__all__")
    lines = ["# Python API", "", "The names of the package `chta`, from its sources; [the package](README.md) shows how they are used.", ""]
    titles = {
        "_scenario": "Scenarios",
        "_answers": "Answers",
        "_arrays": "Arrays",
        "_machine": "Machine and ground",
        "_errors": "Errors",
    }
    homes = {a.name: n.module for n in tree.body if isinstance(n, ast.ImportFrom) and n.module for a in n.names}
    unknown = {homes[n] for n in public if n in homes} - set(titles) - {"_chta"}
    if unknown:
        raise ValueError(f"docs/guide/site_hooks.py has no title for the modules {sorted(unknown)} of chta")
    for module, title in titles.items():
        lines += [f"## {title}", ""]
        for name in public:
            if homes.get(name) == module:
                lines += [f"::: chta.{module}.{name}", ""]
    lines += ["## Campaigns", "", "::: chta.campaign", "    options:", "      show_root_heading: false", "      show_root_toc_entry: false", ""]
    return "\n".join(lines)


def _schemas(folder: Path) -> str:
    names = sorted(path.name for path in folder.glob("*.json"))
    rows = [f"- [`{name.removesuffix('.json')}`]({name})" for name in names]
    intro = (
        "JSON schemas of a scenario, of a robot file and of every answer; `chta schema KIND` prints the same. "
        "[Keys and columns](../columns.md) has them as tables."
    )
    return "\n".join(["# Schemas", "", intro, "", *rows, ""])


def _robots(folder: Path) -> str:
    rows = [f"- [`{path.name}`]({path.name})" for path in sorted(folder.glob("*.toml"))]
    return "\n".join(["# Robots", "", "Robot files that come with the program ([legs](../../docs/legs.md)).", "", *rows, ""])


def on_files(files: Files, config: MkDocsConfig) -> Files:
    pages = Path(config.docs_dir)
    for path, content in {
        "python/api.md": _api(),
        "docs/schema/README.md": _schemas(pages / "docs/schema"),
        "data/robots/README.md": _robots(pages / "data/robots"),
    }.items():
        files.append(File.generated(config, path, content=content))
    return files


def on_page_markdown(markdown: str, page, config: MkDocsConfig, files: Files) -> str:  # noqa: ANN001
    """Leads links to folders to the page of the folder."""

    def led(match: re.Match[str]) -> str:
        target = posixpath.normpath(posixpath.join(posixpath.dirname(page.file.src_uri), match[2]))
        index = f"{target}/README.md"
        return f"{match[1]}{match[2].rstrip('/')}/README.md{match[3]}" if files.get_file_from_path(index) else match[0]

    return LINK.sub(led, markdown)
