"""The Processing script: by `qgis_process` where it is, else read, loaded beside stand-ins of the classes of QGIS, and run."""

import ast
import importlib.util
import json
import os
import pathlib
import shutil
import subprocess
import sys
import types

import pytest
from conftest import ROOT, command

SCRIPT = ROOT / "python/qgis/chta_processing.py"
DEM = str(ROOT / "data/terrain/lunar_rille.tif")
SCENARIO = str(ROOT / "data/scenarios/lunar_rille.toml")


class Algorithm:
    """What the script needs of QgsProcessingAlgorithm."""

    def __init__(self) -> None:
        self.parameters: dict[str, tuple[object, ...]] = {}

    def addParameter(self, parameter: "Parameter") -> None:
        self.parameters[str(parameter.words[0])] = parameter.words

    def parameterAsRasterLayer(self, parameters, name, context):
        return types.SimpleNamespace(source=lambda: parameters[name], crs=lambda: "crs")

    def parameterAsPoint(self, parameters, name, context, crs):
        x, y = parameters[name]
        assert crs == "crs"
        return types.SimpleNamespace(x=lambda: x, y=lambda: y)

    def parameterAsString(self, parameters, name, context):
        return parameters.get(name, "")

    def parameterAsInt(self, parameters, name, context):
        # The default stands fourth.
        return parameters.get(name, self.parameters[name][3])

    def parameterAsEnum(self, parameters, name, context):
        return parameters.get(name, 0)

    parameterAsFile = parameterAsOutputLayer = parameterAsFileOutput = parameterAsString


class Parameter:
    Integer = 0

    def __init__(self, *words: object, **more: object) -> None:
        self.words = words


class Feedback:
    def __init__(self, cancelled: bool = False) -> None:
        self.told: list[str] = []
        self.cancelled = cancelled
        self.pushInfo = self.pushWarning = self.told.append

    def isCanceled(self) -> bool:
        return self.cancelled


@pytest.fixture
def script(monkeypatch: pytest.MonkeyPatch) -> types.ModuleType:
    names = [
        alias.name
        for node in ast.parse(SCRIPT.read_text(encoding="utf-8")).body
        if isinstance(node, ast.ImportFrom) and node.module == "qgis.core"
        for alias in node.names
    ]
    core = types.ModuleType("qgis.core")
    for name in names:
        setattr(core, name, Algorithm if name == "QgsProcessingAlgorithm" else RuntimeError if name.endswith("Exception") else Parameter)
    assert {"QgsProcessingAlgorithm", "QgsProcessingException"} < set(names)
    monkeypatch.setitem(sys.modules, "qgis", types.ModuleType("qgis"))
    monkeypatch.setitem(sys.modules, "qgis.core", core)
    monkeypatch.setenv("CHTA_COMMAND", command())
    spec = importlib.util.spec_from_file_location("chta_processing", SCRIPT)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def run(script: types.ModuleType, parameters: dict, feedback: Feedback) -> dict:
    algorithm = script.ChtaAlgorithm()
    algorithm.initAlgorithm()
    return algorithm.processAlgorithm(parameters, None, feedback)


def test_maps_sites_and_plans(script: types.ModuleType, tmp_path: pathlib.Path) -> None:
    raster, path = str(tmp_path / "out.tif"), str(tmp_path / "path.geojson")
    common = {"DEM": DEM, "SCENARIO": SCENARIO, "START": (60.0, 60.0), "STRIDE": 8}
    told = Feedback()
    found = run(script, {**common, "RASTER": raster}, told)
    assert found["RASTER"] == raster and "reachable_posts" in told.told[-1]
    direct = tmp_path / "direct.tif"
    words = ["map", DEM, "--scenario", SCENARIO, "--start=60.0,60.0", "--stride", "8", "-o", str(direct)]
    subprocess.run([command(), *words], check=True, capture_output=True)
    assert direct.read_bytes() == pathlib.Path(raster).read_bytes()
    sites = {**common, "QUESTION": 1, "STRIDE": 16, "EVERY": 4, "RASTER": str(tmp_path / "sites.tif")}
    assert os.path.exists(run(script, sites, Feedback())["RASTER"])
    free = {**common, "QUESTION": 2, "GOAL": (100.0, 70.0), "PATH": path, "SET": "terrain.route=free; search.node_spacing_max_m=4"}
    found = run(script, free, Feedback())
    assert found["VERDICT"] == "traversable"
    assert json.loads(pathlib.Path(path).read_text(encoding="utf-8"))["type"] == "FeatureCollection"


def test_what_the_script_refuses(script: types.ModuleType, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    common = {"DEM": DEM, "SCENARIO": SCENARIO}
    with pytest.raises(RuntimeError, match="a map needs a start"):
        run(script, {**common, "RASTER": str(tmp_path / "out.tif")}, Feedback())
    with pytest.raises(RuntimeError, match="a plan needs a start and a goal"):
        run(script, {**common, "QUESTION": 2, "START": (60, 60)}, Feedback())
    wrong = {**common, "START": (60, 60), "RASTER": str(tmp_path / "out.tif"), "SET": "hopper.clearence_m=1"}
    with pytest.raises(RuntimeError, match="hopper.clearance_m"):
        run(script, wrong, Feedback())
    monkeypatch.delenv("CHTA_COMMAND")
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(RuntimeError, match="found no program chta"):
        run(script, {**common, "START": (60, 60), "RASTER": str(tmp_path / "out.tif")}, Feedback())


@pytest.mark.skipif(shutil.which("qgis_process") is None, reason="there is no qgis_process")
def test_qgis_runs_it(tmp_path: pathlib.Path) -> None:
    profile = tmp_path / "profile"
    scripts = profile / "profiles/default/processing/scripts"
    scripts.mkdir(parents=True)
    shutil.copy(SCRIPT, scripts)
    raster = tmp_path / "out.tif"
    parameters = ["QUESTION=0", f"DEM={DEM}", f"SCENARIO={SCENARIO}", "START=60,60", "STRIDE=8", f"RASTER={raster}"]
    words = ["qgis_process", "run", "script:chta", "--", *parameters]
    environment = {**os.environ, "CHTA_COMMAND": command(), "QGIS_CUSTOM_CONFIG_PATH": str(profile), "QT_QPA_PLATFORM": "offscreen"}
    ran = subprocess.run(words, env=environment, capture_output=True, text=True, check=False)
    assert ran.returncode == 0 and raster.exists(), ran.stderr
