# SPDX-License-Identifier: Apache-2.0
"""Makes tests/report/stored of a report, small enough to keep. usage: store.py DIR

It keeps some contenders, some frames, and every kind of run; figures are those that were measured.
"""
import json
import pathlib
import sys

HERE = pathlib.Path(__file__).parent
CONTENDERS = ("certified-compute", "fast-compute", "cpu-kdtree", "embree-robust", "embree-packets")
FRAMES = 6
DROPPED = ("checksum", "pass_seconds", "kernel_seconds", "queues", "of_ranks_told")


def thin(value):
    if isinstance(value, dict):
        return {k: thin(v) for k, v in value.items() if k not in DROPPED}
    if isinstance(value, list):
        return [thin(v) for v in value]
    return float(f"{value:.6g}") if isinstance(value, float) else value


def kept(run):
    result = run["result"]
    for scene in result.get("scenes", []) if result else []:
        for name in ("contenders", "measurements"):
            scene[name] = [one for one in scene[name]
                           if one.get("contender", one.get("label")).split(",")[0] in CONTENDERS]
    if result and isinstance(result.get("frames"), list):
        result["frames"] = result["frames"][:FRAMES]
    return thin(run)


def main():
    (HERE / "stored").mkdir(exist_ok=True)
    for path in sorted(pathlib.Path(sys.argv[1]).glob("*.json")):
        document = json.loads(path.read_text())
        if "experiment" not in document:
            continue
        document["runs"] = [kept(run) for run in document["runs"]
                            if not run["key"].startswith("kitchen")]
        (HERE / "stored" / path.name).write_text(json.dumps(document, separators=(",", ":")) + "\n")


if __name__ == "__main__":
    main()
