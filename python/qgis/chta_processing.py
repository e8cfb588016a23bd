"""Maps of hops, landing sites and plans of the program `chta` as an algorithm of the Processing toolbox of QGIS (3.22 or newer).

Processing > Toolbox > Scripts > Add Script to Toolbox takes this file. The program `chta` is found on the PATH, or by the environment
variable CHTA_COMMAND. Layers are read by the program: the elevations have to be a GeoTIFF, an ESRI ASCII grid or a PDS3 image on a map in
metres.
"""

import json
import os
import shutil
import subprocess

from qgis.core import (
    QgsProcessingAlgorithm,
    QgsProcessingException,
    QgsProcessingParameterEnum,
    QgsProcessingParameterFile,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterNumber,
    QgsProcessingParameterPoint,
    QgsProcessingParameterRasterDestination,
    QgsProcessingParameterRasterLayer,
    QgsProcessingParameterString,
)

QUESTIONS = ("map", "sites", "plan")
QUESTIONS_IN_WORDS = (
    "map: fewest hops from the start to everywhere",
    "sites: landing sites ranked, every so many nodes",
    "plan: the path from start to goal",
)


def place(point):
    """A point as the program takes it; `None` stays."""
    return None if point is None else f"{point[0]!r},{point[1]!r}"


def command(program, question, dem, scenario, start=None, goal=None, stride=1, every=8, settings=(), raster=None, vector=None):
    """The words of a command. Raises ValueError for what is missing."""
    if question == "plan":
        if start is None or goal is None:
            raise ValueError("a plan needs a start and a goal")
        if vector is None:
            raise ValueError("a plan needs a file for its path")
        words = [program, "plan", scenario, "--set", f"terrain.dem={os.path.abspath(dem)}", f"--start={place(start)}"]
        words += [f"--goal={place(goal)}", "--geojson", vector]
    elif question == "sites":
        if raster is None:
            raise ValueError("landing sites need a file for their raster")
        words = [program, "sites", dem, "--scenario", scenario, "--stride", str(stride), "--every", str(every), "-o", raster]
        words += [f"--target={place(goal)}"] if goal is not None else []
    else:
        if start is None or raster is None:
            raise ValueError("a map needs a start and a file for its raster")
        words = [program, "map", dem, "--scenario", scenario, f"--start={place(start)}", "--stride", str(stride), "-o", raster]
        if goal is not None:
            words += [f"--goal={place(goal)}"]
            words += ["--geojson", vector] if vector is not None else []
    for setting in settings:
        words += ["--set", setting]
    return [*words, "--format", "json"]


def program():
    """The program, by the environment or on the PATH."""
    named = os.environ.get("CHTA_COMMAND") or shutil.which("chta")
    if named is None:
        raise ValueError("found no program chta on the PATH: install it with `cargo install --path .`, or set CHTA_COMMAND")
    return named


class ChtaAlgorithm(QgsProcessingAlgorithm):
    """Runs `chta` and loads what it wrote."""

    def name(self):
        """The name in commands: `qgis_process run script:chta`."""
        return "chta"

    def displayName(self):
        """The name in the toolbox."""
        return "Hops over terrain (chta)"

    def group(self):
        """The group in the toolbox."""
        return "Traversability"

    def groupId(self):
        """The name of the group in commands."""
        return "traversability"

    def shortHelpString(self):
        """What the dialog says."""
        return (
            "How a hopping robot crosses the terrain: the fewest hops from a start to every node (-1 is not reached over these nodes), "
            "landing sites ranked by what is reached from each, or a path. The scenario (TOML) states body, hopper and surface; its own "
            "terrain is replaced by the elevations given here."
        )

    def createInstance(self):
        """Another one of the same."""
        return ChtaAlgorithm()

    def initAlgorithm(self, config=None):
        """The parameters."""
        self.addParameter(QgsProcessingParameterEnum("QUESTION", "Question", list(QUESTIONS_IN_WORDS), defaultValue=0))
        self.addParameter(QgsProcessingParameterRasterLayer("DEM", "Elevations"))
        self.addParameter(QgsProcessingParameterFile("SCENARIO", "Scenario (TOML)", extension="toml"))
        self.addParameter(QgsProcessingParameterPoint("START", "Start (map, plan)", optional=True))
        self.addParameter(QgsProcessingParameterPoint("GOAL", "Goal, or target of sites", optional=True))
        integer = QgsProcessingParameterNumber.Integer
        self.addParameter(QgsProcessingParameterNumber("STRIDE", "Every so many posts are nodes", integer, 1, False, 1))
        self.addParameter(QgsProcessingParameterNumber("EVERY", "Every so many nodes are sites", integer, 8, False, 1))
        keys = "Keys to set, such as hopper.takeoff_speed_max_m_s=8 (separated by semicolons)"
        self.addParameter(QgsProcessingParameterString("SET", keys, "", optional=True))
        self.addParameter(QgsProcessingParameterRasterDestination("RASTER", "Raster of map or sites", optional=True))
        self.addParameter(QgsProcessingParameterFileDestination("PATH", "Path", "GeoJSON (*.geojson)", optional=True))

    def processAlgorithm(self, parameters, context, feedback):
        """Runs the program. A path that does not exist is an answer: its verdict is told, and nothing is loaded."""
        layer = self.parameterAsRasterLayer(parameters, "DEM", context)

        def point(name):
            if parameters.get(name) in (None, ""):
                return None
            found = self.parameterAsPoint(parameters, name, context, layer.crs())
            return found.x(), found.y()

        question = QUESTIONS[self.parameterAsEnum(parameters, "QUESTION", context)]
        raster = self.parameterAsOutputLayer(parameters, "RASTER", context) or None
        vector = self.parameterAsFileOutput(parameters, "PATH", context) or None
        settings = [one.strip() for one in self.parameterAsString(parameters, "SET", context).split(";") if one.strip()]
        try:
            words = command(
                program(),
                question,
                layer.source(),
                self.parameterAsFile(parameters, "SCENARIO", context),
                point("START"),
                point("GOAL"),
                self.parameterAsInt(parameters, "STRIDE", context),
                self.parameterAsInt(parameters, "EVERY", context),
                settings,
                raster,
                vector,
            )
        except ValueError as error:
            raise QgsProcessingException(str(error)) from error
        feedback.pushInfo(" ".join(words))
        answer = self.answer(words, feedback)
        for warning in answer["warnings"]:
            feedback.pushWarning(warning)
        told = {key: answer[key] for key in ("verdict", "hops", "reachable_posts", "farthest_hops") if key in answer}
        feedback.pushInfo(json.dumps(told))
        written = {"RASTER": raster, "PATH": vector}
        outputs = {name: file for name, file in written.items() if file is not None and os.path.exists(file)}
        return {**outputs, "VERDICT": answer.get("verdict", "")}

    def answer(self, words, feedback):
        """Runs a command to its end, or until it is cancelled, and reads its answer. Exit status 1 is the answer no."""
        with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as ran:
            while True:
                try:
                    said, errors = ran.communicate(timeout=0.2)
                    break
                except subprocess.TimeoutExpired:
                    if feedback.isCanceled():
                        ran.terminate()
        if ran.returncode not in (0, 1):
            raise QgsProcessingException(errors.strip() or f"chta ended with status {ran.returncode}")
        return json.loads(said)
