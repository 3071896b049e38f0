# SPDX-License-Identifier: Apache-2.0
"""Error against run time, and the extreme cases."""
import data
import draw
from page import Section, Table, listed, words

RAYS = ("primary", "shadow", "diffuse", "edges")
RAY_NAMES = {"primary": "camera rays", "shadow": "shadow rays", "diffuse": "bounced rays",
             "edges": "rays at corners and sides"}
FAMILIES = ("certified", "fast", "embree", "cpu", "thesis")
FAMILY_NAMES = {"certified": "Overcast, certified", "fast": "Overcast, fast", "embree": "Embree",
                "cpu": "KD-tree, CPU", "thesis": "the thesis", "povray": "POV-Ray",
                "tachyon": "Tachyon"}
PEERS = ("embree", "cpu")
SERIES = {"certified": 0, "fast": 2, "embree": 1, "cpu": 3, "thesis": 7, "povray": 4, "tachyon": 5}


def label(name):
    """embree-robust: Embree robust; certified-compute: certified, compute."""
    first, _, rest = name.partition("-")
    if first == "embree":
        return f"Embree {rest}"
    return {"cpu-kdtree": "KD-tree in doubles", "cpu-float-kdtree": "KD-tree in floats"}.get(
        name, f"{first}, {rest}" if rest else first)


def family(name):
    return next((f for f in SERIES if name.startswith(f)), "cpu")


def per_million(count, rays):
    return None if count is None or not rays else 1e6 * count / rays


def contender_of(m):
    rays = m["rays"]
    samples = [1e9 * s / rays for s in m["call_seconds"]["samples"]]
    name = m["contender"].split(",")[0]
    return {"key": name, "name": label(name), "family": family(m["contender"]),
            "ns": data.spread(samples), "samples": samples,
            **{key: per_million(m[key], rays) for key in ("tied", "wrong", "beside", "leaked")},
            "t_rms": m["t_error_rms"], "t_max": m["t_error_largest"], "t_ulps": m["t_error_ulps"]}


def workload_of(name, measurements):
    all_ = [contender_of(m) for m in measurements]
    ours = min((c for c in all_ if c["family"] == "certified"), key=lambda c: c["ns"]["median"])
    result = {"workload": name, "rays": measurements[0]["rays"], "ours": ours, "contenders": all_,
              "peer": None, "robust": None, "fast": None}
    for key, of in (("peer", [c for c in all_ if c["family"] in PEERS]),
                    ("robust", [c for c in all_ if c["key"] == "embree-robust"]),
                    ("fast", [c for c in all_ if c["family"] == "fast"])):
        if of:
            best = min(of, key=lambda c: c["ns"]["median"])
            result[key] = {"name": best["name"], "contender": best,
                           "speed": data.paired(best["samples"], ours["samples"])}
    return result


def bench_scenes(runs):
    scenes = []
    for key in runs.keys():
        if key == "budget":
            continue
        scene = runs.result(key)["scenes"][0]
        by_workload = {}
        for m in scene["measurements"]:
            by_workload.setdefault(m["workload"], []).append(m)
        scenes.append({"key": key,
                       "scene": "kitchen" if key == "kitchen" else data.scene_name(scene["scene"]),
                       "triangles": scene["triangles"], "threads": scene["threads"],
                       "renderer": scene["contenders"][0]["renderer"],
                       "quiet": runs.run(key)["quiet"],
                       "workloads": [workload_of(w, ms) for w, ms in by_workload.items()]})
    return scenes


def budget_of(runs):
    result = runs.result("budget")
    if not result:
        return None
    scene = result["scenes"][0]
    frames = [m for m in scene["measurements"] if m["workload"] == "frame"]
    if len(frames) != 2:
        return None
    whole, part = frames
    return {"scene": data.scene_name(scene["scene"]), "share": 30,
            "time": data.paired(part["call_seconds"]["samples"], whole["call_seconds"]["samples"]),
            "pixels": part["differ"] - whole["differ"], "moved_mb": 1e-6 * part["bytes_in"],
            "pages_mb": 1e-6 * scene["contenders"][0]["level2_bytes"],
            "quiet": runs.run("budget")["quiet"]}


def pictures_of(runs):
    scenes = []
    for key in runs.keys("scene-"):
        result = runs.result(key)
        programs = {}
        for choice in result["choices"]:
            programs.setdefault(choice["program"], []).append(
                {"samples": choice["samples"], "seconds": data.spread(choice["wall_seconds"]),
                 "rmse": choice["rmse"]})
        scenes.append({"scene": data.scene_name(result["scene"]), "size": result["size"],
                       "programs": [{"program": p, "points": pts} for p, pts in programs.items()],
                       "not_installed": result["not_installed"]})
    return scenes


def shapes_of(runs):
    result = runs.result("shapes")
    if not result:
        return []
    rows = []
    for row in result["rows"]:
        seconds = row["import_seconds"] + row["build_seconds"] + row["call_seconds"]
        rows.append({"choice": row["choice"], "tolerance": row["tolerance"],
                     "triangles": row["triangles"],
                     "milliseconds": 1e3 * seconds,
                     "distance": max(row["largest_distance"].values()),
                     "rmse": (row["picture"] or {}).get("rmse"),
                     "picture_seconds": (row["picture"] or {}).get("seconds")})
    return rows


def bars_of(runs):
    """The lines of `overcast bench --bars`: what each promises, and what was measured."""
    verdicts = {"passed": "holds", "failed": "misses"}
    return [{**{key: bar[key] for key in ("line", "measured", "low", "high", "better")},
             "bar": bar["at_least"], "verdict": verdicts.get(bar["verdict"], bar["verdict"])}
            for bar in (runs.result("bars") or {}).get("bars", []) if bar["verdict"] != "skipped"]


def error_figures(documents):
    runs = data.Runs(documents.get("error"))
    scenes = bench_scenes(runs)
    rays = sum(w["rays"] for s in scenes for w in s["workloads"])
    wins, comparisons = 0, 0
    for scene in scenes:
        for w in scene["workloads"]:
            if scene["key"] != "systems" and w["peer"] and w["workload"] != "edges":
                comparisons += 1
                wins += w["peer"]["speed"]["median"] >= 1
    ours = [(w["rays"], w["ours"]) for s in scenes for w in s["workloads"]]
    return {"scenes": scenes, "rays": rays, "comparisons": comparisons, "wins": wins,
            "peer_wins": comparisons - wins,
            "our_errors": sum(n * (o["tied"] + o["wrong"] + o["leaked"]) / 1e6 for n, o in ours),
            "budget": budget_of(runs), "pictures": pictures_of(data.Runs(documents.get("samples"))),
            "shapes": shapes_of(data.Runs(documents.get("tessellation"))),
            "bars": bars_of(data.Runs(documents.get("programs")))}


def call_panel(name, title, workload, value, label, floor):
    panel = draw.Panel(name, title, "ns a ray, call to return", label).log("x")
    drawn = []
    for f in FAMILIES:
        of = [c for c in workload["contenders"] if c["family"] == f and value(c) is not None]
        drawn += [(c["ns"]["median"], value(c)) for c in of]
        panel.points(SERIES[f], FAMILY_NAMES[f], [(c["ns"]["median"], value(c)) for c in of],
                     [(c["ns"]["low"], c["ns"]["high"]) for c in of], filled=f == "certified")
    edge = data.frontier(drawn)
    panel.axes.plot(*zip(*edge), color=draw.INK, linewidth=0.8, drawstyle="steps-post", alpha=0.6)
    return panel.log("y", floor)


def error_panels(figures):
    panels = []
    scene = next((s for s in figures["scenes"] if s["key"] != "systems"), None)
    if scene:
        of = {w["workload"]: w for w in scene["workloads"]}
        for kind in ("primary", "diffuse", "edges"):
            if kind in of:
                panels.append(call_panel(f"error-{kind}", f"{scene['scene']}: {RAY_NAMES[kind]}",
                                         of[kind], lambda c: c["wrong"] + c["leaked"],
                                         "wrong and leaked a million", 1))
        if "diffuse" in of:
            panels.append(call_panel("error-t", f"{scene['scene']}: t of bounced rays",
                                     of["diffuse"], lambda c: c["t_rms"], "RMS error of t", 1e-9))
    systems = next((s for s in figures["scenes"] if s["key"] == "systems"), None)
    for w in systems["workloads"] if systems else []:
        if w["workload"] == "diffuse":
            panels.append(call_panel("error-systems", f"{systems['scene']}, beside the thesis",
                                     w, lambda c: c["wrong"] + c["leaked"],
                                     "wrong and leaked a million", 1))
            panels[-1].legend()
    if panels:
        panels[0].legend()
    for n, scene in enumerate(figures["pictures"][:1]):
        panel = draw.Panel(f"error-samples-{n}", f"{scene['scene']}: 1, 4, 16 … samples a pixel",
                           "seconds, whole program", "RMS error of the picture").log("x").log("y")
        for program in scene["programs"]:
            panel.points(SERIES[family(program["program"])], FAMILY_NAMES.get(
                family(program["program"]), program["program"]),
                         [(p["seconds"]["median"], p["rmse"]) for p in program["points"]
                          if p["rmse"] > 0], line=True)
        panel.legend()
        panels.append(panel)
    if figures["shapes"]:
        panel = draw.Panel("error-shapes", "Finer triangles against exact shapes",
                           "ms: read, build, trace", "largest distance, radii")
        panel.log("x").log("y")
        for n, name, given in ((0, "by tolerance", True), (1, "the reader's choice", False)):
            panel.points(n, name, [(r["milliseconds"], r["distance"]) for r in figures["shapes"]
                                   if r["distance"] > 0 and
                                   r["choice"].startswith("tolerance") == given], line=given)
        panel.legend()
        panels.append(panel)
    return panels


def bars_table(f, bars):
    table = Table("Promises of speed that do not hold, of those of overcast bench --bars",
                  ["line", "measured", "from", "to", "promised", "verdict"], [])
    for i, bar in enumerate(bars):
        if bar["verdict"] == "holds":
            continue
        at = ("error", "bars", i)
        table.rows.append([bar["line"], f.n(*at, "measured"), f.n(*at, "low"), f.n(*at, "high"),
                           words(["at least " if bar["better"] == "more" else "at most ",
                                  f.n(*at, "bar")]),
                           bar["verdict"]])
    return table


def error_section(f):
    figures = f.at("error")
    calls = Table("Calls: ours and the fastest peer, in its best setting", [
        "scene", "rays", "ours", "ns a ray", "best peer", "ns", "times as fast as it", "spread",
        "peer: tied", "wrong", "of them beside", "leaked, a million", "t error, ulps"], [])
    for s, scene in enumerate(figures["scenes"]):
        for w, of in enumerate(scene["workloads"]):
            at = ("error", "scenes", s, "workloads", w)
            peer = at + ("peer", "contender")
            row = [scene["scene"], RAY_NAMES[of["workload"]], of["ours"]["name"],
                   f.n(*at, "ours", "ns", "median")]
            if of["peer"]:
                row += [of["peer"]["name"], f.n(*peer, "ns", "median"),
                        f.n(*at, "peer", "speed", "median"), f.range(*at, "peer", "speed")]
                row += [f.n(*peer, k) for k in ("tied", "wrong", "beside", "leaked", "t_ulps")]
            else:
                row += ["none"] + ["–"] * 8
            calls.rows.append(row)
    tables = [calls]
    if figures["bars"]:
        tables.append(bars_table(f, figures["bars"]))
    for p, scene in enumerate(figures["pictures"]):
        table = Table(f"Pictures of {scene['scene']} by samples a pixel",
                      ["program", "samples", "seconds", "RMS error"], [])
        for q, program in enumerate(scene["programs"]):
            for r, _ in enumerate(program["points"]):
                at = ("error", "pictures", p, "programs", q, "points", r)
                table.rows.append([program["program"], f.n(*at, "samples"),
                                   f.n(*at, "seconds", "median"), f.n(*at, "rmse")])
        tables.append(table)
    if figures["shapes"]:
        tables.append(Table("Round shapes as triangles", [
            "choice", "tolerance", "triangles", "ms", "largest distance", "picture error"],
            [[row["choice"] if "tolerance" not in row["choice"] else "given"] + [
                f.n("error", "shapes", r, k)
                for k in ("tolerance", "triangles", "milliseconds", "distance", "rmse")]
             for r, row in enumerate(figures["shapes"])]))
    claim = words(["Certified answers had ", f.n("error", "our_errors"), " errors in ",
                   f.n("error", "rays"), " rays; in ", f.n("error", "peer_wins"), " of ",
                   f.n("error", "comparisons"), " comparisons of camera, shadow and bounced rays a "
                   "peer in its fastest setting took less time."])
    return Section("error", "Error against run time", claim,
                   "Each mark is a contender in one setting, its bar the spread of rounds; the "
                   "line "
                   "is the frontier, filled marks are certified. Every contender answers the same "
                   "rays, in numbers that floats have. An answer that names another triangle is "
                   "tied where exact arithmetic finds the same t, else wrong; a wrong answer is "
                   "beside where t is within four units of the last place.",
                   panels=error_panels(figures), tables=tables)


GROUPS = (("hard to decide", "away", "hub", "spine", "10,000", "fan", "1e76", "decided exactly"),
          ("ill transforms", "instances"), ("far from the origin", " at ", "far-terrain"),
          ("huge and tiny", "times", "denormal", "t near", "1e-30 to", "geometric"),
          ("slivers", "sliver", "grazing"), ("grid of scale, offset, aspect", "strip: aspect"),
          ("seams, duplicates, planes", "twice", "coplanar", "zero area", "planes"),
          ("starting on a surface", "from a", "at a hit"),
          ("bad numbers", "NaN"), ("corners and sides", ""))
PROGRAMS = (("certified", "certified", 0), ("fast", "fast", 2), ("embree_robust", "Embree robust",
1),
            ("embree_default", "Embree default", 4))


def group_of(name):
    return next(names[0] for names in GROUPS if any(part in name for part in names[1:]))


def stiff_figures(documents):
    runs = data.Runs(documents.get("stiff"))
    cases = [c for key in ("stability", "grid") for c in (runs.result(key)
    or {"cases": []})["cases"]]
    groups, sums = {}, {key: {"tied": 0, "wrong": 0, "leaks": 0} for key, _, _ in PROGRAMS}
    for case in cases:
        group = groups.setdefault(group_of(case["name"]), {"rays": 0})
        group["rays"] += case["rays"]
        for key, _, _ in PROGRAMS:
            score = case.get(key)
            if not score:
                continue
            extra = case["wrong_occlusions"] if key == "certified" else 0
            for kind in ("tied", "wrong", "leaks"):
                count = score[kind] + (extra if kind == "wrong" else 0)
                for sum_ in (group.setdefault(key, {"tied": 0, "wrong": 0, "leaks": 0}), sums[key]):
                    sum_[kind] += count
    listed_ = [{"group": name, **groups[name]} for name, *_ in GROUPS if name in groups]
    for group in listed_:
        for key, _, _ in PROGRAMS:
            if key in group:
                group[key] = {k: per_million(v, group["rays"]) for k, v in group[key].items()}
    typical = next((c["microseconds"] for c in cases if c["name"] == "valid rays, for time"), None)
    cliffs = [{"name": c["name"], "times": c["time_ratio"], "microseconds": c["microseconds"]}
              for c in cases if c.get("bar") and c.get("time_ratio")]
    optics = (runs.result("stability") or {}).get("optics", [])
    rays = sum(c["rays"] for c in cases)
    return {"groups": listed_, "cases": len(cases), "rays": rays, "sums": sums,
            "cliffs": sorted(cliffs, key=lambda c: -c["times"]), "typical_microseconds": typical,
            "worst_cliff": max((c["times"] for c in cliffs), default=None),
            "quiet": all(run["quiet"] for run in runs.all),
            "optics": {"cases": len(optics), "rays": sum(o["rays"] for o in optics),
                       "wrong": sum(o["wrong"] + o["leaks"] for o in optics)}}


def stiff_section(f):
    figures = f.at("stiff")
    panel = draw.Panel("stiff-groups", "Wrong and leaked a million rays", "", "", size=(4.4, 4.2))
    names = [g["group"] for g in figures["groups"]]
    for key, label, series in PROGRAMS:
        points = [(g[key]["wrong"] + g[key]["leaks"], i) for i, g in enumerate(figures["groups"])
                  if key in g]
        panel.points(series, label, points)
    panel.log("x", 10)
    panel.axes.set_yticks(range(len(names)), names)
    panel.axes.invert_yaxis()
    panel.legend()
    cliffs = draw.Panel("stiff-cliffs", "The slowest rays", "times a ray decided exactly", "",
                        size=(4.4, 4.2))
    cliffs.rows([c["name"] for c in figures["cliffs"]], [c["times"] for c in figures["cliffs"]],
                log=True)
    cliffs.limit(x=100)
    table = Table("Groups of cases, a million rays", ["cases", "rays"] + [
        f"{label}: {kind}" for _, label, _ in PROGRAMS[1:3] for kind in ("tied", "wrong",
        "leaked")],
        [[g["group"], f.n("stiff", "groups", i, "rays")] + [
            f.n("stiff", "groups", i, key, kind) if key in g else "–"
            for key, _, _ in PROGRAMS[1:3] for kind in ("tied", "wrong", "leaks")]
         for i, g in enumerate(figures["groups"])])
    cost = Table("The slowest rays", ["case", "times", "µs a ray"], [
        [words(c["name"].split("\n")), f.n("stiff", "cliffs", i, "times"),
         f.n("stiff", "cliffs", i, "microseconds")] for i, c in enumerate(figures["cliffs"])])
    at = ("stiff", "sums")
    claim = words(["In ", f.n("stiff", "cases"), " cases that are hard on arithmetic certified "
                   "answers had ", f.n(*at, "certified", "wrong"), " wrong and ",
                   f.n(*at, "certified", "leaks"), " leaked of ", f.n("stiff", "rays"),
                   " rays; Embree robust had ", f.n(*at, "embree_robust", "wrong"), " wrong, ",
                   f.n(*at, "embree_robust", "leaks"), " leaked and ",
                   f.n(*at, "embree_robust", "tied"), " tied."])
    return Section("stiff", "Stiff and extreme cases", claim, words([
        "Answers are compared with exact arithmetic. Embree holds floats: far from the origin its "
        "positions are rounded, which is its limit and not an error of its own. The dashed line is "
        "the promise. Stiff optics (refraction near index one, mirrors, rays off tiny surfaces): ",
        f.n("stiff", "optics", "wrong"), " wrong of ", f.n("stiff", "optics", "rays"), " rays."]),
        panels=[panel, cliffs], tables=[table, cost])
