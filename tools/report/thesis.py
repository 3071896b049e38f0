# SPDX-License-Identifier: Apache-2.0
"""The figures of chapter 4 of the thesis, and pictures."""
import pathlib

import data
import draw
from page import Section, Table, picture, words

NAMES = {"kdt": "CPU KD-tree", "single": "single texture", "batched": "two-level, batched",
         "mixed": "two-level, mixed", "product-batched": "Overcast, batched",
         "product-mixed": "Overcast, mixed", "product-budget": "Overcast, budget"}
SERIES = {"kdt": 3, "single": 7, "batched": 4, "mixed": 5, "product-batched": 0, "product-mixed": 2,
          "product-budget": 1}
# Megabytes of textures for the dragons, of table 4.2.
REPORTED_MB = {1: 68.3, 5: 286, 11: 616, 21: 1130}


def system_of(result):
    frames = [frame for frame in result["frames"] if frame["complete"]]
    if not frames:
        return None
    return {"cpu_s": sum(f["time"]["cpu"] for f in frames) / len(frames),
            "calls": sum(f["passes"] for f in frames) / len(frames) or None,
            "frames": [[f["frame"], f["time"]["cpu"]] for f in frames],
            "pages_mb": 1e-6 * result["level2_bytes"] or None, "triangles": result["triangles"],
            "active": [[f["frame"], 100 * f["active"]["bytes"] / result["level2_bytes"]]
                       for f in frames if f.get("active")]}


def ratio(systems, a, b, key="cpu_s"):
    over, under = (systems.get(name) or {} for name in (a, b))
    return over[key] / under[key] if over.get(key) and under.get(key) else None


def finding(figure, what, says, theirs, ours):
    return {"figure": figure, "what": what, "says": says, "theirs": theirs, "ours": ours}


def common(figure, faster, calls, time, systems):
    return [finding(figure, "batched: times as fast as the KD-tree", faster,
                    ratio(systems, "kdt", "batched"), ratio(systems, "kdt", "product-batched")),
            finding(figure, "calls, mixed over batched", calls,
                    ratio(systems, "mixed", "batched", "calls"),
                    ratio(systems, "product-mixed", "product-batched", "calls")),
            finding(figure, "time, mixed over batched", time, ratio(systems, "mixed", "batched"),
                    ratio(systems, "product-mixed", "product-batched"))]


def thesis_figures(documents):
    runs = data.Runs(documents.get("thesis"))
    scenes = {}
    for run in runs.all:
        scene, system = run["key"].rsplit("--", 1)
        of = None if "refused" in run["result"] else system_of(run["result"])
        scenes.setdefault(scene, {})[system] = of
    findings = []
    dragons = {int(s.split("-")[1]): v for s, v in scenes.items() if s.startswith("dragons-")}
    if dragons:
        most = dragons[max(dragons)]
        findings += common("4.5, 4.6", "2 to 5", "about 0.5", "below 1", most)

        def bytes_a_triangle(name):
            of = most.get(name) or {}
            return 1e6 * of["pages_mb"] / of["triangles"] if of.get("pages_mb") else None

        findings.append(finding("table 4.2", "bytes a triangle", "64 to 67",
                                bytes_a_triangle("batched"), bytes_a_triangle("product-batched")))
        findings.append(finding("4.5", "dragons rendered, at most", "18", max(
            (n for n in dragons if dragons[n].get("batched")), default=None), max(
                (n for n in dragons if dragons[n].get("product-budget")), default=None)))
    leaves = {int(s.split("-")[1]): v for s, v in scenes.items() if s.startswith("dragonball-")}
    if leaves:
        def best(system):
            return min((n for n in leaves if leaves[n].get(system)),
                       key=lambda n: leaves[n][system]["cpu_s"], default=None)
        findings.append(finding("4.7, 4.8", "leaves with which batched is fastest", "2, the fewest",
                                best("batched"), best("product-batched")))
    for scene, figure, says in (
            ("plants", "4.10, 4.11", ("2.5", "about 0.5", "slightly below 1")),
            ("powerplant", "4.13, 4.14", ("over 10", "nearly 1 indoors", "slightly above 1"))):
        if scene in scenes:
            findings += common(figure, *says, scenes[scene])
    return {"scenes": scenes, "findings": findings,
            "dragons": sorted(dragons), "leaves": sorted(leaves),
            "frames": max((len(s["frames"]) for of in scenes.values() for s in of.values() if s),
                          default=None)}


def curves(panel, of):
    """of: {system: points}."""
    for system, points in of.items():
        panel.points(SERIES[system], NAMES[system], [p for p in points if p[1]], line=True)
    return panel


def thesis_panels(figures):
    scenes, panels = figures["scenes"], []
    for stem, counts, x, title in (
            ("dragons", figures["dragons"], "dragons", "Figure 4.5: time a frame"),
            ("dragonball", figures["leaves"], "leaves", "Figures 4.7, 4.8: leaves of dragonball")):
        if counts:
            panel = draw.Panel(f"thesis-{stem}", title, x, "CPU seconds a frame").log("x")
            panel.ticks(counts)
            systems = {s for n in counts for s in scenes[f"{stem}-{n}"]}
            panels.append(curves(panel, {
                s: [(n, scenes[f"{stem}-{n}"][s]["cpu_s"]) for n in counts
                    if scenes[f"{stem}-{n}"].get(s)] for s in SERIES if s in systems}))
    for scene, figure in (("plants", "Figure 4.10"), ("powerplant", "Figure 4.13")):
        if scene in scenes:
            panel = draw.Panel(f"thesis-{scene}", f"{figure}: {scene}", "frame",
                               "CPU seconds a frame")
            panels.append(curves(panel, {s: scenes[scene][s]["frames"] for s in SERIES
                                         if scenes[scene].get(s)}))
    active = {scene: scenes[scene]["active"]["active"] for scene in ("plants", "powerplant")
              if (scenes.get(scene) or {}).get("active")}
    if active:
        panel = draw.Panel("thesis-active", "Figures 4.12, 4.15: pages that a frame uses", "frame",
                           "% of the bytes of all")
        for n, (scene, points) in enumerate(active.items()):
            panel.points(n, scene, points, line=True)
        panel.legend()
        panels.append(panel)
    if panels:
        panels[0].legend()
    return panels


def thesis_section(f):
    figures = f.at("thesis")
    table = Table("What the thesis reports, its systems here, and Overcast", [
        "figure: what", "the thesis", "its system here", "Overcast"], [
        [f"{one['figure']}: {one['what']}", one["says"], f.n("thesis", "findings", i, "theirs"),
         f.n("thesis", "findings", i, "ours")] for i, one in enumerate(figures["findings"])])
    place = {one["what"]: i for i, one in enumerate(figures["findings"])}
    first = place.get("calls, mixed over batched")
    claim = words(["The thesis' order of its systems is found again: mixed takes ",
                   f.n("thesis", "findings", first, "theirs") if first is not None else "–",
                   " of batched's calls on the last scene of the table, where it reports about "
                   "half."])
    return Section("thesis", "The thesis' figures", claim, words([
        "Up to ", f.n("thesis", "frames"), " frames of each camera path. Frames are compared by "
        "the "
        "CPU seconds of all threads while rays are traced and shaded: where a software renderer "
        "does "
        "the GPU's part, no GPU's lead over the CPU can show. Calls, rays and bytes are as on a "
        "GPU."]),
        panels=thesis_panels(figures), tables=[table])


CAPTIONS = {"partition": "Figure 3.5: leaves of level 1 in colours",
            "dragons": "Figure 4.1: dragons", "dragonball": "Dragonball",
            "plants": "Figure 4.3: plants", "plants-partition": "Its leaves of level 1",
            "powerplant": "Power plant"}


def pictures_figures(documents):
    return {"shots": [{"key": run["key"], "file": run["picture"],
                       "triangles": run["result"]["triangles"], "leaves": run["result"]["leaves"],
                       "seconds": run["result"]["time"]["render"]}
                      for run in data.Runs(documents.get("pictures")).all if run.get("picture")]}


def pictures_section(f, folder):
    figures = f.at("pictures")
    pictures = [picture(pathlib.Path(folder) / shot["file"], CAPTIONS.get(shot["key"], shot["key"]))
                for shot in figures["shots"] if (pathlib.Path(folder) / shot["file"]).exists()]
    table = Table("The pictures", ["picture", "triangles", "leaves", "seconds"], [
        [CAPTIONS.get(s["key"], s["key"])] + [f.n("pictures", "shots", i, k)
                                              for k in ("triangles", "leaves", "seconds")]
        for i, s in enumerate(figures["shots"])])
    most = max(range(len(figures["shots"])), key=lambda i: figures["shots"][i]["triangles"],
               default=None)
    claim = words(["The thesis' scenes, the largest of ",
                   f.n("pictures", "shots", most, "triangles") if most is not None else "–",
                   " triangles, drawn by the product."])
    return Section("pictures", "Pictures", claim, "Leaves of level 1 are what moves into the GPU's "
                   "memory and out of it.", pictures=pictures, tables=[table])
