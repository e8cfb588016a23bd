"""Campaigns: many cases of one scenario, on this machine or on a Dask cluster, in parts that survive a crash.

>>> import chta
>>> cases = [{"hopper.takeoff_speed_max_m_s": speed} for speed in (3.0, 5.0)]
>>> done = chta.campaign.run(cases, "data/scenarios/simple_reduced.toml")
>>> [(row["holds"], row["hops"]) for row in done.rows]
[(False, None), (True, 5)]
"""

from __future__ import annotations

import collections
import hashlib
import json
import os
import pathlib
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ._chta import VERSION
from ._answers import Simulation
from ._errors import ChtaError, InputError
from ._scenario import Scenario, Source, scenario_of

if TYPE_CHECKING:
    import distributed
    import pandas

QUESTIONS = ("plan", "check", "simulate")
"""What a campaign asks of every case."""

Row = dict[str, Any]
"""One case: ``case`` (its number from 0), ``key``, ``holds``, ``hops``, ``error`` and ``document`` (JSON)."""


class Campaign:
    """The answers of all cases, in their order."""

    def __init__(self, cases: Sequence[Mapping[str, Any]], rows: list[Row]) -> None:
        self.cases = [dict(case) for case in cases]
        self.rows = rows

    def __len__(self) -> int:
        return len(self.rows)

    def documents(self) -> list[dict[str, Any] | None]:
        """The documents; ``None`` where a case has an error."""
        return [None if row["document"] is None else json.loads(row["document"]) for row in self.rows]

    @property
    def warnings(self) -> dict[str, int]:
        """The warnings of all answers, such as of a key without effect, and to how many cases each applies; the most frequent first."""
        said = collections.Counter(warning for document in self.documents() if document for warning in document["warnings"])
        return dict(said.most_common())

    def to_frame(self) -> pandas.DataFrame:
        """One row a case: the keys that were set and the answer, without the document (extra ``pandas``)."""
        import pandas as pd

        answers = [{name: value for name, value in row.items() if name != "document"} for row in self.rows]
        table: pandas.DataFrame = pd.DataFrame([{**case, **answer} for case, answer in zip(self.cases, answers)])
        return table


def key_of(scenario: Scenario, question: str) -> str:
    """The name of a case in parts: the SHA-256 of the scenario as used, of the content of its files, of the question and of the version."""
    text = json.dumps([VERSION, question, scenario.tables(), scenario._draft.checksums()], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def answers(
    scenario: Scenario,
    cases: Sequence[Mapping[str, Any]],
    first: int,
    question: str,
    threads: int | None,
    content: Sequence[str] | None = None,
) -> list[Row]:
    """The rows of some cases, of which the first has this number: one task of a cluster. Terrain that they have in common is read once; with
    the checksums of the scenario's files, once for all tasks of a worker."""
    shared = scenario._sharing() if content is None else _shared(scenario, tuple(content))
    return [_answer(shared, case, first + number, question, threads) for number, case in enumerate(cases)]


_kept: tuple[tuple[Any, ...], Scenario] | None = None
"""The last scenario of the tasks of this worker: with terrain that was read."""


def _shared(scenario: Scenario, content: tuple[str, ...]) -> Scenario:
    """A scenario whose files have these checksums, with the terrain of the task before if that was of the same one."""
    global _kept
    name = (*scenario._source, json.dumps(scenario.tables(), sort_keys=True), os.getcwd(), content)
    if _kept is None or _kept[0] != name:
        _kept = (name, scenario._sharing())
    return _kept[1]


def _answer(scenario: Scenario, case: Mapping[str, Any], number: int, question: str, threads: int | None) -> Row:
    row: Row = {"case": number, "key": None, "holds": None, "hops": None, "error": None, "document": None}
    try:
        varied = scenario._varied(case)
        row["key"] = key_of(varied, question)
        answer = getattr(varied, question)(threads=threads)
    except ChtaError as error:
        row["error"] = str(error)
        return row
    row["holds"], row["document"] = answer.holds, answer.json().decode()
    row["hops"] = answer.document().get("hops")
    return row


def run(
    cases: Iterable[Mapping[str, Any]] | pandas.DataFrame,
    scenario: Source,
    client: distributed.Client | None = None,
    *,
    question: str = "plan",
    batch: int = 50,
    folder: str | os.PathLike[str] | None = None,
    threads: int | None = 1,
) -> Campaign:
    """Asks a question of every case, each of which sets keys of the scenario: mappings, or a data frame whose columns are keys.

    Without a ``client`` the cases are answered here, one after the other. With a client of Dask, tasks of ``batch`` cases go to its
    workers, which have this package and the same working folder; the tasks of a worker that dies are done again by another one. The rows
    are the same bytes however they were made.

    With a ``folder``, each batch is written there whole when it is done, and batches that are there are not computed again: after a
    crash of this program or of the cluster, the same call goes on where it ended. ``threads`` are those of one case.
    """
    if question not in QUESTIONS:
        raise InputError(f"question is {question!r}, expected one of {', '.join(QUESTIONS)}")
    if batch < 1:
        raise InputError(f"batch is {batch}, expected a whole number of at least 1")
    listed = _listed(cases)
    opened = scenario_of(scenario)
    store = None if folder is None else _Store(pathlib.Path(folder))
    rows: dict[int, list[Row]] = {}
    wanted: list[tuple[int, Sequence[Mapping[str, Any]], str]] = []
    for first in range(0, len(listed), batch):
        part = listed[first : first + batch]
        name = _name(opened, part, first, question)
        kept = None if store is None else store.read(name)
        if kept is None:
            wanted.append((first, part, name))
        else:
            rows[first] = kept
    for first, name, done in _done(opened, wanted, client, (question, threads, _content(opened))):
        rows[first] = done
        if store is not None:
            store.write(name, done)
    return Campaign(listed, [row for first in sorted(rows) for row in rows[first]])


def simulate(
    scenario: Source,
    client: distributed.Client | None = None,
    *,
    trials: int | None = None,
    seed: int | None = None,
    policy: str | None = None,
    success_min: float | None = None,
    batch: int = 1000,
    folder: str | os.PathLike[str] | None = None,
    threads: int | None = 1,
) -> Simulation:
    """Trials of one scenario in ranges of ``batch`` trials, here or on the workers of a client of Dask: the draws of a trial depend on the
    seed and its number alone, so that the answer has the bytes of `Scenario.simulate` at once. Every range plans the path anew.

    With a ``folder``, the tally of each range is written there whole, and ranges that are there are not flown again.

    >>> import chta
    >>> quick = {"uncertainty.policy": "open-loop", "search.risk": "ignored"}
    >>> scenario = chta.Scenario.open("data/scenarios/rolling_surely.toml", set=quick)
    >>> chta.campaign.simulate(scenario, trials=50, batch=20).json() == scenario.simulate(trials=50).json()
    True
    """
    if batch < 1:
        raise InputError(f"batch is {batch}, expected a whole number of at least 1")
    keys = {"trials": trials, "seed": seed, "policy": policy}
    opened = scenario_of(scenario, {f"uncertainty.{key}": value for key, value in keys.items() if value is not None})
    errors = opened.tables().get("uncertainty")
    if errors is None:
        return opened.simulate(success_min=success_min, threads=threads)
    count = int(errors["trials"])
    store = None if folder is None else _Store(pathlib.Path(folder))
    content = _content(opened)
    tallies: dict[int, str] = {}
    wanted: list[tuple[int, int, str]] = []
    for first in range(0, count, batch):
        text = json.dumps([VERSION, "tally", first, min(batch, count - first), opened.tables(), content], sort_keys=True)
        name = hashlib.sha256(text.encode()).hexdigest()[:32]
        kept = None if store is None else store.read(name)
        if kept is None:
            wanted.append((first, min(batch, count - first), name))
        else:
            tallies[first] = kept[0]["tally"]
    for first, name, tally in _flown(opened, wanted, client, threads):
        if tally is None:
            # Without a path nothing is flown, and the answer says so.
            return opened.simulate(success_min=success_min, threads=threads)
        tallies[first] = tally
        if store is not None:
            store.write(name, [{"tally": tally}])
    return opened.merged([tallies[first] for first in sorted(tallies)], success_min=success_min, threads=threads)


def _tally(scenario: Scenario, first: int, trials: int, threads: int | None) -> str | None:
    """One task of a cluster."""
    return scenario.tally(first, trials, threads=threads)


def _flown(
    scenario: Scenario, wanted: list[tuple[int, int, str]], client: distributed.Client | None, threads: int | None
) -> Iterator[tuple[int, str, str | None]]:
    """The ranges as they are flown."""
    if client is None:
        for first, trials, name in wanted:
            yield first, name, _tally(scenario, first, trials, threads)
        return
    from distributed import as_completed

    of_task = {}
    for first, trials, name in wanted:
        task = client.submit(_tally, scenario, first, trials, threads, key=f"chta-{name}", retries=10, pure=True)
        of_task[task] = (first, name)
    for task in as_completed(list(of_task)):
        first, name = of_task.pop(task)
        yield first, name, task.result()


def _done(
    scenario: Scenario,
    wanted: list[tuple[int, Sequence[Mapping[str, Any]], str]],
    client: distributed.Client | None,
    asked: tuple[str, int | None, list[str] | None],
) -> Iterator[tuple[int, str, list[Row]]]:
    """The batches as they are done."""
    if client is None:
        for first, part, name in wanted:
            yield first, name, answers(scenario, part, first, *asked)
        return
    from distributed import as_completed

    of_task = {}
    for first, part, name in wanted:
        # A task is harmless to repeat, so a dying worker is no reason to give up on it.
        task = client.submit(answers, scenario, part, first, *asked, key=f"chta-{name}", retries=10, pure=True)
        of_task[task] = (first, name)
    for task in as_completed(list(of_task)):
        first, name = of_task.pop(task)
        yield first, name, task.result()


def _listed(cases: Any) -> list[dict[str, Any]]:
    if hasattr(cases, "to_dict") and hasattr(cases, "columns"):
        return [{str(key): value for key, value in row.items()} for row in cases.to_dict("records")]
    return [dict(case) for case in cases]


def _plain(value: Any) -> Any:
    return value.tolist() if hasattr(value, "tolist") else os.fspath(value)


def _name(scenario: Scenario, part: Sequence[Mapping[str, Any]], first: int, question: str) -> str:
    """The name of a batch: its cases decide it, not where it is computed."""
    named = [scenario.tables(), _content(scenario), [[case, _content(scenario, case)] for case in part]]
    text = json.dumps([VERSION, question, first, named], sort_keys=True, default=_plain)
    return hashlib.sha256(text.encode()).hexdigest()[:32]


FILES = ("robot.file", "terrain.dem", "terrain.mesh", "terrain.chain", "surface.friction_raster", "surface.keep_out", "surface.keep_in")
"""The keys that name files, of which a case sets some; and the errors and the rasters of layers."""


def _content(scenario: Scenario, case: Mapping[str, Any] | None = None) -> list[str] | None:
    """The checksums of the files of a scenario, or of a case that names files of its own; ``None`` where they cannot be read."""
    if case is not None and not any(key in FILES or key == "uncertainty.errors" or key.endswith(".raster") for key in case):
        return None
    try:
        return (scenario if case is None else scenario.with_keys(case))._draft.checksums()
    except ChtaError:
        return None


class _Store:
    """The batches of a folder, each a file of JSON lines."""

    def __init__(self, folder: pathlib.Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self._folder = folder

    def _path(self, name: str) -> pathlib.Path:
        return self._folder / f"part-{name}.jsonl"

    def read(self, name: str) -> list[Row] | None:
        """A batch, if it is there: a file is renamed to its place when it is whole."""
        try:
            lines = self._path(name).read_text(encoding="utf-8").splitlines()
        except FileNotFoundError:
            return None
        return [json.loads(line) for line in lines]

    def write(self, name: str, rows: list[Row]) -> None:
        """Writes a batch whole or not at all."""
        handle, temporary = tempfile.mkstemp(dir=self._folder, prefix=".part-")
        try:
            with os.fdopen(handle, "w", encoding="utf-8") as file:
                for row in rows:
                    file.write(json.dumps(row) + "\n")
                file.flush()
                os.fsync(file.fileno())
            os.replace(temporary, self._path(name))
        except BaseException:
            pathlib.Path(temporary).unlink(missing_ok=True)
            raise
