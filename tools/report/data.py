# SPDX-License-Identifier: Apache-2.0
"""Reads the experiments' JSON files, and does the statistics that the sections share."""
import json
import math
import pathlib
import statistics

SCHEMA = "overcast-report-1"


class Problem(Exception):
    """Something about the input that the user can change, as a sentence."""


def load(folder):
    """Returns {experiment: its JSON}, of the files of the folder that are experiments'."""
    found = {}
    for path in sorted(pathlib.Path(folder).glob("*.json")):
        try:
            document = json.loads(path.read_text())
        except ValueError as error:
            raise Problem(f"{path} is no JSON: {error}") from error
        if not isinstance(document, dict) or "experiment" not in document:
            continue
        if document.get("schema") != SCHEMA:
            raise Problem(f"{path} has the schema '{document.get('schema')}'; this program reads "
                          f"{SCHEMA}: measure again with the same version")
        found[document["experiment"]] = document
    return found


class Runs:
    """The runs of an experiment that have a result."""

    def __init__(self, document):
        self.document = document or {"runs": []}
        self.all = [run for run in self.document["runs"] if run["result"]]

    def __bool__(self):
        return bool(self.all)

    def keys(self, start=""):
        return [run["key"] for run in self.all if run["key"].startswith(start)]

    def run(self, key):
        return next((run for run in self.all if run["key"] == key), None)

    def result(self, key):
        run = self.run(key)
        return run["result"] if run else None


def scene_name(path):
    """A scene without its folder and its ending, if it is a file."""
    name = path.rsplit("/", 1)[-1]
    return name.split(".")[0] if "/" in path else name


def median(values):
    return statistics.median(values)


def spread(values):
    """The median of samples and how far they reach, as a dictionary."""
    return {"median": median(values), "low": min(values), "high": max(values)}


def paired(over, under):
    """The ratios of samples that were taken by turns, round by round."""
    return spread([a / b for a, b in zip(over, under) if b > 0] or [math.nan])


# Two-sided 95 % of Student's t by degrees of freedom; beyond these 2.
STUDENT = (None, 12.71, 4.30, 3.18, 2.78, 2.57, 2.45, 2.36, 2.31, 2.26, 2.23)


def power_law(points):
    """Fits y = c x^k by least squares of logarithms. Returns k, the bounds of its 95 % interval
    (none for two points), and c; nothing for fewer points or one x."""
    logs = [(math.log(x), math.log(y)) for x, y in points if x and y and x > 0 and y > 0]
    if len(logs) < 2 or len({x for x, _ in logs}) < 2:
        return None
    mean_x, mean_y = (statistics.mean(column) for column in zip(*logs))
    squares = sum((x - mean_x) ** 2 for x, _ in logs)
    k = sum((x - mean_x) * (y - mean_y) for x, y in logs) / squares
    fit = {"k": k, "low": None, "high": None, "c": math.exp(mean_y - k * mean_x)}
    free = len(logs) - 2
    if free > 0:
        rest = sum((y - mean_y - k * (x - mean_x)) ** 2 for x, y in logs)
        student = STUDENT[free] if free < len(STUDENT) else 2.0
        half = student * math.sqrt(rest / free / squares)
        fit.update(low=k - half, high=k + half)
    return fit


def frontier(points):
    """The points (cost, error) that no other has both less or equal of, by growing cost."""
    best, kept = math.inf, []
    for cost, error in sorted(points):
        if error < best:
            kept.append((cost, error))
            best = error
    return kept


def quiet(document):
    """How many timed runs of an experiment were made beside other programs, and the worst load."""
    runs = document["runs"]
    return {"runs": len(runs), "noisy": sum(not run["quiet"] for run in runs),
            "others": max((run["load"]["others_during"] for run in runs), default=0),
            "repeated": sum(run["attempts"] > 1 for run in runs)}
