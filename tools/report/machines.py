# SPDX-License-Identifier: Apache-2.0
"""Several processes that share a scene: measured, simulated by tools/scale, and projected; and what
a GPU kit brought back."""
import dataclasses
import json
import math
import pathlib
import sys

import data
import draw
from page import Section, Table, words

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "scale"))
import model  # noqa: E402
import scale  # noqa: E402

PIXELS = 1920 * 1080
NETWORK, DISK, MEMORY = 2.5e10, 5e9, 64e9  # bytes a second of a node, twice; bytes of a rank
BYTES_A_TRIANGLE = 65  # page and corners


def rates_of(runs, threads):
    best = {}
    for run in runs.all:
        ranks = int(run["key"].split("-")[1])
        rates = scale.rates_of(run["result"], ranks)
        at = best.setdefault(str(ranks), rates)
        if rates["seconds"] < at["seconds"]:
            best[str(ranks)] = rates
    return {"cores": threads, "runs": best}


def simulated(rates, machine, ranks):
    on = dataclasses.replace(machine, ranks_per_node=ranks)
    return model.simulate(on, scale.job_of(rates["runs"][str(ranks)], ranks))[0]


def projected(rates, machine):
    """Seconds of a picture at this machine's own speed, on one rank a node: what the busiest of a
    rank's cores, network and disk takes, with the rates that the simulation was fitted to. A scene
    of more triangles is deeper, never cheaper than the measured one."""
    alone = rates["runs"]["1"]
    grown = PIXELS / alone["primary"]
    rays = alone["rays"] * grown
    imbalance = max(run["imbalance"] for run in rates["runs"].values())
    for triangles in (1e8, 1e9, 1e10, 1e11):
        for ranks in (1, 64, 1000):
            share = triangles * BYTES_A_TRIANGLE / ranks
            deeper = 1 + 0.06 * max(0.0, math.log2(triangles / ranks / alone["triangles"]))
            here = rays / ranks
            away = here * scale.away_at(rates, ranks)
            takes = {"cores": imbalance * (here + away) * deeper * machine.visit_seconds +
                     away * machine.away_seconds +
                     here * (machine.shade_seconds + (machine.route_seconds if ranks > 1 else 0)),
                     "network": away * (model.VISIT_BYTES + model.ANSWER_BYTES) / NETWORK,
                     "disk": share / 2 / DISK if share > MEMORY else 0}
            limit = max(takes, key=takes.get)
            measured = alone["seconds"] * grown / ranks
            yield {"triangles": triangles, "ranks": ranks, "seconds": max(takes[limit], measured),
                   "measured_rate_seconds": measured, "limit": limit}


def machines_figures(documents):
    document = documents.get("machines")
    runs = data.Runs(document)
    if not runs or not {"1", "2", "4"} <= {key.split("-")[1] for key in runs.keys()}:
        return {"rows": [], "projection": []}
    rates = rates_of(runs, document["machine"]["threads"])
    machine = scale.fitted(rates)
    rows = [{"ranks": int(n), "seconds": rates["runs"][n]["seconds"],
             "simulated": simulated(rates, machine, int(n)),
             "visits": rates["runs"][n]["away_per_ray"],
             "imbalance": rates["runs"][n]["imbalance"]} for n in sorted(rates["runs"], key=int)]
    for row in rows:
        row["off_percent"] = 100 * (row["simulated"] / row["seconds"] - 1)
    return {"scene": data.scene_name(runs.all[0]["result"]["scene"]), "cores": rates["cores"],
            "rows": rows, "worst_off_percent": max(abs(r["off_percent"]) for r in rows),
            "assumed": {"network": NETWORK, "disk": DISK, "memory": MEMORY, "pixels": PIXELS},
            "projection": list(projected(rates, machine))}


def machines_section(f):
    figures = f.at("machines")
    if not figures["rows"]:
        return Section("machines", "Machines", "Not measured: it takes mpirun (openmpi-bin).")
    panel = draw.Panel("machines-ranks", f"{figures['scene']}: ranks of one thread each",
                       "ranks on this machine", "seconds a picture").log("x").log("y")
    for n, key in ((0, "seconds"), (3, "simulated")):
        panel.points(n, "measured" if key == "seconds" else "simulated",
                     [(r["ranks"], r[key]) for r in figures["rows"]], line=True, filled=n == 0)
    panel.ticks([r["ranks"] for r in figures["rows"]])
    panel.legend()
    far = draw.Panel("machines-projection", "Projected: a picture of two million pixels",
                     "triangles", "seconds").log("x").log("y")
    for n, ranks in enumerate(sorted({r["ranks"] for r in figures["projection"]})):
        far.points(n, f"{ranks:,} rank" + "s" * (ranks > 1), [(r["triangles"], r["seconds"])
                                           for r in figures["projection"] if r["ranks"] == ranks],
                   line=True)
    far.legend(columns=3)
    measured = Table("Ranks on this machine", ["ranks", "seconds", "simulated", "off %",
                                               "visits elsewhere a ray", "busiest share"], [
        [f.n("machines", "rows", i, k) for k in ("ranks", "seconds", "simulated", "off_percent",
                                                 "visits", "imbalance")]
        for i in range(len(figures["rows"]))])
    projection = Table("Projected, not measured", ["triangles", "ranks", "seconds", "limited by"], [
        [f.n("machines", "projection", i, k) for k in ("triangles", "ranks", "seconds")] +
        [r["limit"]]
        for i, r in enumerate(figures["projection"])])
    claim = words(["Ranks that share a scene answer the same picture; a simulation of their "
    "messages "
                   "is off by at most ", f.n("machines", "worst_off_percent"), " % of what ",
                   f.n("machines", "rows", -1 % len(figures["rows"]), "ranks"), " ranks on ",
                   f.n("machines", "cores"), " cores take."])
    at = ("machines", "assumed")
    return Section("machines", "Machines", claim, words([
        "Ranks of one machine share its cores, so that more of them cannot be faster than there "
        "are "
        "cores. The projection assumes this machine's speed a rank, one rank a node, a network of ",
        f.n(*at, "network"), " and a disk of ", f.n(*at, "disk"), " bytes a second, ",
        f.n(*at, "memory"), " bytes of memory a rank, half of a larger share read once, and "
        "visits elsewhere "
        "a ray that grow with the cube root of the ranks; it is never below the measured time of a "
        "ray."
        ]), panels=[panel, far], tables=[measured, projection])


def gpu_figures(path):
    """The figures of a kit's JSON (tests/kit)."""
    try:
        kit = json.loads(pathlib.Path(path).read_text())
        parts = {part["name"]: part for part in kit["parts"]}
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise data.Problem(f"{path} is no kit.json: {error}") from error
    rows, device = [], ""
    for name in ("kernels", "memory", "moving"):
        for scene in ((parts.get(name) or {}).get("json") or {}).get("scenes", []):
            device = scene["contenders"][0]["renderer"]
            rows += [{"part": name, "what": f"{m['contender']}, {m['workload']}",
                      "mrays": m["call_seconds"]["mrays_per_second"],
                      "kernel": (m["kernel_seconds"] or {}).get("mrays_per_second")}
                     for m in scene["measurements"]]
    bars = ((parts.get("bars") or {}).get("json") or {}).get("bars", [])
    return {"device": device, "system": kit.get("system", ""), "failures": kit.get("failures", 0),
            "version": kit.get("kit", ""), "rows": rows,
            "held": sum(bar["verdict"] == "passed" for bar in bars),
            "missed": sum(bar["verdict"] == "failed" for bar in bars)}


def gpu_section(f):
    figures = f.at("gpu")
    table = Table("The kit's measurements", ["part: what", "Mrays/s", "kernel alone"], [
        [f"{r['part']}: {r['what']}", f.n("gpu", "rows", i, "mrays"), f.n("gpu", "rows", i,
        "kernel")]
        for i, r in enumerate(figures["rows"])])
    panel = draw.Panel("gpu-rays", "Mrays/s, call to return", "", "", size=(6, 4))
    rows = [r for r in figures["rows"] if r["mrays"]]
    panel.rows([r["what"] for r in rows], [r["mrays"] for r in rows])
    claim = words(["A kit ran on ", figures["device"] or figures["system"], ": ",
                   f.n("gpu", "failures"), " of its parts failed, ", f.n("gpu", "held"),
                   " promises held and ", f.n("gpu", "missed"), " missed."])
    return Section("gpu", "On another machine", claim, figures["system"], panels=[panel],
                   tables=[table], again=["./run.sh"])
