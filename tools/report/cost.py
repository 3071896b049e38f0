# SPDX-License-Identifier: Apache-2.0
"""What was left out, cost as work grows, and memory."""
import data
import draw
from page import Section, Table, listed, words

# The quantity of a sweep, in the words of a title and of an axis.
SWEPT = {"budget": ("the budget grows", "budget, % of the bytes of all pages")}
SWITCHES = {"shadows": "shadow rays", "bounces": "reflection and refraction", "cutouts": "cut-out "
"leaves",
            "proofs": "proofs of answers", "queues": "queues of rays between leaves",
            "working-set": "telling which pages are used"}


def left_out_rows(runs):
    """A row for each scene and switch, of runs that were made by turns."""
    sides = {}
    for run in runs.all:
        scene, rest = run["key"].split("--", 1)
        switch, side, which = rest.rsplit("-", 2)
        sides.setdefault((scene, switch), {}).setdefault((side, which == "cold"), []).append(run)
    rows = []
    for (scene, switch), of in sides.items():
        if any((side, cold) not in of for side in ("with", "without") for cold in (False, True)):
            continue
        seconds = {side: [r["result"]["time"]["cpu"] for r in of[side, False]]
                   for side in ("with", "without")}
        saved = data.paired([w - o for w, o in zip(seconds["with"], seconds["without"])],
                            seconds["with"])
        row = {"scene": scene, "what": SWITCHES.get(switch, switch),
               "saved": {k: 100 * v for k, v in saved.items()},
               "quiet": all(r["quiet"] for side in ("with", "without") for r in of[side, False])}
        for side in ("with", "without"):
            last, cold = of[side, False][-1]["result"], of[side, True][0]
            row[side] = {"cpu_ms": 1e3 * data.median(seconds[side]),
                         "gpu_mb": 1e-6 * last["gpu_peak_bytes"],
                         "kernel_kb": 1e-3 * cold.get("kernel_bytes", 0) or None,
                         "compile_ms": 1e3 * cold["result"]["time"]["cpu"]}
        rows.append(row)
    return rows


def left_out_figures(documents):
    runs = data.Runs(documents.get("left-out"))
    files = {}
    for run in (r for name in ("left-out", "growth", "thesis", "pictures", "memory")
                for r in data.Runs(documents.get(name)).all):
        for item in run["result"].get("left_out", []):
            if item["bytes"] > 0:
                files[(data.scene_name(run["result"]["scene"]), item["what"])] = {
                    "kb": 1e-3 * item["bytes"], "pages_kb": 1e-3 * run["result"]["level2_bytes"]}
    rows = left_out_rows(runs)
    told = [{"scene": s, "what": w, **v} for (s, w), v in sorted(files.items())]
    gains = [r for r in rows if r["saved"]["low"] > 0]
    return {"rows": rows, "told": told, "gains": len(gains), "switched": len(rows),
            "best": max(rows, key=lambda r: r["saved"]["median"], default=None),
            "told_kb": sum(t["kb"] for t in told)}


def left_out_section(f):
    figures = f.at("left-out")
    panel = draw.Panel("left-out-saved", "CPU seconds saved by leaving it out", "% of them", "",
                       size=(5.4, 3.4))
    panel.rows([f"{r['scene']}: {r['what']}" for r in figures["rows"]],
               [r["saved"]["median"] for r in figures["rows"]],
               [(r["saved"]["low"], r["saved"]["high"]) for r in figures["rows"]])
    panel.limit(x=0)
    table = Table("With and without", ["scene: what", "saved %", "spread", "CPU ms with", "without",
                                       "compiling ms with", "without", "kernels kB with", "without",
                                       "GPU MB with", "without"], [])
    for i, row in enumerate(figures["rows"]):
        at = ("left-out", "rows", i)
        table.rows.append([f"{row['scene']}: {row['what']}", f.n(*at, "saved", "median"),
                           f.range(*at, "saved")] + [
            f.n(*at, side, key) for key in ("cpu_ms", "compile_ms", "kernel_kb", "gpu_mb")
            for side in ("with", "without")])
    tables = [table]
    if figures["told"]:
        tables.append(Table("Bytes of files that are not stored", ["scene: what", "kB", "pages "
        "kB"], [
            [f"{t['scene']}: {t['what']}", f.n("left-out", "told", i, "kb"),
             f.n("left-out", "told", i, "pages_kb")] for i, t in enumerate(figures["told"])]))
        told = words(["files' bytes that no picture needed came to ", f.n("left-out", "told_kb"),
        " kB"])
    else:
        told = "no file here had bytes that a picture did not need"
    claim = words([f.n("left-out", "gains"), " of ", f.n("left-out", "switched"),
                   " parts saved time in every pair of runs when a "
                   "picture did without them, and ", told, "."])
    return Section("left-out", "What was left out", claim,
                   "Each part is switched on and off on a scene that has it, by turns; bars are "
                   "medians, lines the spread over pairs. Nothing is credited that no scene had.",
                   panels=[panel], tables=tables)


def growth_figures(documents):
    runs = data.Runs(documents.get("growth"))
    sweeps = []
    for key in ("rays", "triangles", "instances", "leaves", "budget"):
        result = runs.result(key)
        if not result:
            continue
        columns = [{"name": name, "points": [[row["x"], row["values"][c]] for row in result["rows"]
                                             if row["values"][c] is not None]}
                   for c, name in enumerate(result["columns"])
                   if name.endswith(" s") and name != "making s"]
        for column in columns:
            column["fit"] = data.power_law(column["points"])
        sweeps.append({"over": key, "scene": data.scene_name(result["scene"]), "columns": columns})
    threads = {}
    for key in runs.keys("threads-"):
        threads.setdefault(int(key.split("-")[1]), []).append(runs.result(key)["time"])
    if threads:
        columns = [{"name": name, "points": [[n, data.median([value(t) for t in times])]
                                             for n, times in sorted(threads.items())]}
                   for name, value in (("build s", lambda t: t["level1"] + t["level2"]),
                                       ("trace and shade s", lambda t: t["render"]))]
        for column in columns:
            column["fit"] = data.power_law(column["points"])
        sweeps.append({"over": "threads", "scene": "", "columns": columns})
    return {"sweeps": sweeps, "confidence_percent": 95, "projection": projection_of(sweeps)}


def projection_of(sweeps):
    """Carries the fits over triangles on. No figure is below the largest that was measured: a scene
    of more triangles is taken to cost as much at least, and building to be in proportion."""
    of = next((s for s in sweeps if s["over"] == "triangles"), None)
    if not of:
        return []
    rows = []
    for triangles in (1e8, 1e9):
        row = {"triangles": triangles}
        for column in of["columns"]:
            if not column["fit"]:
                continue
            x, y = column["points"][-1]
            least = 1.0 if column["name"] == "build s" else 0.0
            fit = column["fit"]
            high = fit["k"] if fit["high"] is None else fit["high"]
            measured = max(value for _, value in column["points"])
            row[column["name"]] = {
                "low": max(measured, y * (triangles / x) ** max(least, column["fit"]["k"])),
                "high": max(measured, y * (triangles / x) ** max(least, high))}
        rows.append(row)
    return rows


def growth_section(f):
    figures = f.at("growth")
    panels, table = [], Table("Exponents of the power laws that fit, and their intervals", [
        "as … grow: what", "scene", "exponent", "interval", "seconds at the last row"], [])
    for s, sweep in enumerate(figures["sweeps"]):
        grows, axis = SWEPT.get(sweep["over"], (f"{sweep['over']} grow", sweep["over"]))
        panel = draw.Panel(f"growth-{sweep['over']}", f"As {grows}", axis, "seconds",
                           size=(4.0, 2.8)).log("x").log("y")
        for c, column in enumerate(sweep["columns"]):
            fit = column["fit"]
            label = column["name"].removesuffix(" s")
            panel.points(c % 8, label + (f"  {fit['k']:.2f}" if fit else ""), column["points"])
            if fit:
                xs = [p[0] for p in column["points"]]
                panel.axes.plot(xs, [fit["c"] * x ** fit["k"] for x in xs],
                                color=draw.SERIES[c % 8], linewidth=0.9, alpha=0.7)
                at = ("growth", "sweeps", s, "columns", c)
                last = len(column["points"]) - 1
                table.rows.append([f"{sweep['over']}: {label}", sweep["scene"], f.n(*at, "fit",
                "k"),
                                   f.range(*at, "fit"), f.n(*at, "points", last, 1)])
        panel.ticks([p[0] for p in sweep["columns"][0]["points"]])
        panel.legend()
        panels.append(panel)
    tables = [table]
    if figures["projection"]:
        tables.append(Table("Projected, not measured, by triangles", [
            "triangles", "building s", "camera rays s"], [
            [f.n("growth", "projection", i, "triangles"), f.range("growth", "projection", i,
            "build s"),
             f.range("growth", "projection", i, "primary: call s")]
            for i in range(len(figures["projection"]))]))

    def exponent(over, name):
        for s, sweep in enumerate(figures["sweeps"]):
            for c, column in enumerate(sweep["columns"]):
                if sweep["over"] == over and column["name"].startswith(name) and column["fit"]:
                    return f.n("growth", "sweeps", s, "columns", c, "fit", "k")
        return "–"

    claim = words(["A call takes time to the power of ", exponent("rays", "certified"), " in "
    "rays, ",
                   exponent("triangles", "primary"), " in triangles, ",
                   exponent("instances", "primary"), " in instances and ",
                   exponent("leaves", "primary"), " in leaves; one is in proportion, zero is "
                   "free."])
    return Section("growth", "Cost as work grows", claim,
                   words(["Medians of certified calls; lines are the fits, whose exponents stand "
                   "in "
                          "the legends; their intervals are of ", f.n("growth",
                          "confidence_percent"),
                          " % confidence. Small calls have a fixed part, which lowers exponents. "
                          "Assumed by the projection: this machine, all in memory, building in "
                          "proportion at least, the same rays; nothing below what was measured."]),
                   panels=panels, tables=tables)


def peaks(documents):
    """Every budget of GPU memory that was set or taken, with what was used of it."""
    found = []
    for document in documents.values():
        for run in data.Runs(document).all:
            result = run["result"]
            items = [result] + [c for s in result.get("scenes", []) for c in s.get("contenders",
            [])]
            found += [(i["gpu_budget_bytes"], i["gpu_peak_bytes"]) for i in items
                      if i.get("gpu_budget_bytes") and i.get("gpu_peak_bytes")]
    return found


def memory_figures(documents):
    runs = data.Runs(documents.get("memory"))
    rows = []
    for key in runs.keys("host-"):
        result = runs.result(key)
        if "refused" in result:
            rows.append({"host_mb": float(key.split("-")[1]), "refused": result["refused"]})
            continue
        rows.append({"host_mb": 1e-6 * result["host_budget_bytes"] or None,
                     "host_peak_mb": 1e-6 * result["host_budget_peak_bytes"] or None,
                     "gpu_mb": 1e-6 * result["gpu_budget_bytes"],
                     "gpu_peak_mb": 1e-6 * result["gpu_peak_bytes"],
                     "pages_mb": 1e-6 * result["level2_bytes"],
                     "disk_mb": 1e-6 * result["disk_bytes"],
                     "cpu_s": result["time"]["cpu"], "seconds": result["time"]["render"]})
    whole = next((r for r in rows if r.get("seconds") and not r["host_mb"]), None)
    for row in rows:
        row["times"] = row["cpu_s"] / whole["cpu_s"] if whole and "cpu_s" in row else None
    sweep = data.Runs(documents.get("growth")).result("budget")
    gpu = []
    if sweep:
        last = sweep["rows"][-1]["values"]
        frame, moved = sweep["columns"].index("frame: call s"), sweep["columns"].index("MB moved "
        "in")
        gpu = [{"percent": r["x"], "times": r["values"][frame] / last[frame],
                "moved_mb": r["values"][moved]} for r in sweep["rows"]]
    used = peaks(documents)
    over = max((peak - budget for budget, peak in used), default=None)
    return {"host": rows, "gpu": gpu, "budgets": len(used),
            "over_bytes": None if over is None else max(0, over),
            "fullest_percent": max((100 * p / b for b, p in used), default=None)}


def memory_section(f):
    figures = f.at("memory")
    panels = []
    if figures["gpu"]:
        panel = draw.Panel("memory-gpu", "A frame by the share of pages on the GPU",
                           "% of the bytes of all pages", "times the time with all").log("x")
        panel.points(0, "", [(r["percent"], r["times"]) for r in figures["gpu"]], line=True)
        panel.limit(y=1)
        panels.append(panel)
    host = [r for r in figures["host"] if r.get("times") and r["host_mb"]]
    if host:
        panel = draw.Panel("memory-host", "A picture from disk by host memory", "MB of host memory",
                           "times the CPU time without a limit")
        panel.points(1, "", sorted((r["host_mb"], r["times"]) for r in host), line=True)
        panel.limit(y=1)
        panels.append(panel)
    table = Table("A scene file within budgets", ["host MB", "taken", "GPU MB", "taken", "pages MB",
                                                  "read of the disk MB", "CPU s", "times"], [])
    for i, row in enumerate(figures["host"]):
        at = ("memory", "host", i)
        if "refused" in row:
            table.rows.append([f.n(*at, "host_mb"), "refused"] + ["–"] * 6)
        else:
            table.rows.append([f.n(*at, "host_mb") if row["host_mb"] else "no limit"] + [
                f.n(*at, k) for k in ("host_peak_mb", "gpu_mb", "gpu_peak_mb", "pages_mb",
                "disk_mb",
                                      "cpu_s", "times")])
    claim = words(["In ", f.n("memory", "budgets"), " runs under a budget of GPU memory the most "
    "that "
                   "was taken beyond one is ", f.n("memory", "over_bytes"), " bytes; the fullest "
                   "budget "
                   "was used to ", f.n("memory", "fullest_percent"), " %."])
    return Section("memory", "Memory: GPU, host, disk", claim,
                   "Left, all of the scene lies in host memory and the GPU has a part of it; "
                   "right, "
                   "the scene lies on the disk and both have budgets.", panels=panels,
                   tables=[table])
