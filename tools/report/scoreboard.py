# SPDX-License-Identifier: Apache-2.0
"""The ten lines on top of the page, and the five sentences before them."""
import dataclasses

import data
from page import listed, words


@dataclasses.dataclass
class Promise:
    key: str
    section: str
    text: str
    bound: float
    at_most: bool


PROMISES = (
    Promise("exact", "stiff", "Certified answers that differ from exact arithmetic: {}", 0, True),
    Promise("leaks", "stiff", "Rays that leak through a closed mesh: {}", 0, True),
    Promise("primary", "error", "Camera rays: at least {} × the speed of Embree robust", 0.85,
    False),
    Promise("shadow", "error", "Shadow rays: at least {} × its speed", 1.1, False),
    Promise("diffuse", "error", "Bounced rays: at least {} × its speed", 0.85, False),
    Promise("proofs", "error", "Exact answers: at most {} × the time of fast ones", 1.25, True),
    Promise("programs", "error", "File to picture: at least {} × as fast as Tachyon", 2, False),
    Promise("budget", "memory", "A frame with a part of its pages: at most {} × the time", 1.5,
    True),
    Promise("peak", "memory", "Bytes taken beyond a budget of GPU memory: {}", 0, True),
    Promise("cliff", "stiff", "The slowest ray: at most {} × one decided exactly", 100, True))


def programs_figures(documents):
    runs = data.Runs(documents.get("programs"))
    result = runs.result("programs") or (runs.result("bars") or {}).get("programs")
    if not result:
        return {"programs": []}
    times = {p["name"]: p["wall_seconds"] for p in result["programs"] if p["wall_seconds"]}
    rows = [{"name": name, "seconds": data.spread(seconds),
             "ratio": data.paired(seconds, times["overcast"]) if "overcast" in times else None}
            for name, seconds in times.items()]
    return {"mesh": data.scene_name(result["mesh"]), "programs": rows,
            "quiet": all(run["quiet"] for run in runs.all)}


def compared(error, workload):
    """(scene, workload) of all scenes where ours and peers answered these rays."""
    return [(scene, w) for scene in error["scenes"] if scene["key"] != "systems"
            for w in scene["workloads"] if w["workload"] == workload]


def speed_line(error, workload):
    """The worst scene against Embree robust; the peer is the fastest of all."""
    found = [(s, w) for s, w in compared(error, workload) if w["robust"]]
    if not found:
        return None
    scene, w = min(found, key=lambda one: one[1]["robust"]["speed"]["median"])
    return {**w["robust"]["speed"], "scene": scene["scene"], "quiet": scene["quiet"],
            "peer": w["peer"]["name"], "peer_speed": w["peer"]["speed"]["median"]}


def scoreboard_figures(tree):
    error, stiff, memory = tree["error"], tree["stiff"], tree["memory"]
    lines = {promise.key: None for promise in PROMISES}
    peer = stiff["sums"]["embree_robust"]
    if error["scenes"] or stiff["cases"]:
        own = stiff["sums"]["certified"]
        rays = error["rays"] + stiff["rays"]
        peer_rate = 1e6 * (peer["wrong"] + peer["leaks"]) / stiff["rays"] if stiff["rays"] else None
        lines["exact"] = {"median": error["our_errors"] + own["wrong"] + own["leaks"], "rays": rays,
                          "peer": "Embree robust", "peer_per_million": peer_rate, "quiet": True}
        lines["leaks"] = {"median": own["leaks"], "peer": "Embree robust",
                          "peer_leaks": peer["leaks"], "quiet": True}
    for workload in ("primary", "shadow", "diffuse"):
        lines[workload] = speed_line(error, workload)
    proofs = [(s, w) for k in ("primary", "shadow", "diffuse") for s, w in compared(error, k)
    if w["fast"]]
    if proofs:
        scene, w = min(proofs, key=lambda one: one[1]["fast"]["speed"]["median"])
        speed = w["fast"]["speed"]
        lines["proofs"] = {"median": 1 / speed["median"], "low": 1 / speed["high"],
                           "high": 1 / speed["low"], "scene": scene["scene"],
                           "quiet": scene["quiet"]}
    for row in tree["programs"]["programs"]:
        if row["name"] == "tachyon" and row["ratio"]:
            lines["programs"] = {**row["ratio"], "quiet": tree["programs"]["quiet"]}
    if error["budget"]:
        lines["budget"] = {**error["budget"]["time"], "quiet": error["budget"]["quiet"]}
    if memory["over_bytes"] is not None:
        lines["peak"] = {"median": memory["over_bytes"], "quiet": True}
    if stiff["worst_cliff"]:
        lines["cliff"] = {"median": stiff["worst_cliff"], "quiet": stiff["quiet"]}
    for promise in PROMISES:
        line = lines[promise.key]
        if line:
            held = line["median"] <= promise.bound if promise.at_most \
                else line["median"] >= promise.bound
            line["verdict"] = "holds" if held else "misses"
            if not line["quiet"] and "low" in line and line["low"] < promise.bound < line["high"]:
                line["verdict"] = "undecided"  # the spread of a noisy run has the bound within
            line["bound"] = promise.bound
    return lines


def peer_text(f, key, line):
    at = ("scoreboard", key)
    if key == "exact":
        return words([line["peer"], ": ", f.n(*at, "peer_per_million"), " a million, on extreme "
        "cases"])
    if key == "leaks":
        return words([line["peer"], ": ", f.n(*at, "peer_leaks")])
    if key in ("primary", "shadow", "diffuse"):
        ahead = line["peer_speed"] >= 1
        return words([f.n(*at, "peer_speed"), " × the speed of ", line["peer"],
                      "" if ahead else ": the peer wins", f" ({line['scene']})"])
    if key == "programs":
        rest = [i for i, p in enumerate(f.at("programs", "programs")) if p["name"] == "povray"]
        return words(["POV-Ray: ", f.n("programs", "programs", rest[0], "ratio", "median"), " ×"]) \
            if rest else "POV-Ray is not installed"
    if key == "budget":
        return words(["with ", f.n("error", "budget", "share"), " % of them; no peer has this"])
    return f"worst of all scenes: {line['scene']}" if key == "proofs" else "no peer has this"


def scoreboard_lines(f):
    lines = []
    for promise in PROMISES:
        line = f.at("scoreboard", promise.key)
        before, _, after = promise.text.partition("{}")
        if not line:
            lines.append({"section": promise.section, "promise": before + "…" + after,
            "measured": "–",
                          "spread": "–", "verdict": "not measured", "mark": "", "peer": "–"})
            continue
        noisy = "" if line["quiet"] else ", noisy"
        lines.append({"section": promise.section,
                      "promise": words([before, f.n("scoreboard", promise.key, "bound"), after]),
                      "measured": f.n("scoreboard", promise.key, "median"),
                      "spread": f.range("scoreboard", promise.key) if "low" in line
                      else "one run" if promise.key == "cliff" else "a count",
                      "verdict": line["verdict"] + noisy, "mark": line["verdict"],
                      "peer": peer_text(f, promise.key, line)})
    return lines


def fastest(f):
    if not f.at("error", "comparisons"):
        return words(["not measured."])
    peers = [w["peer"]["name"] for scene in f.at("error", "scenes") if scene["key"] != "systems"
             for w in scene["workloads"] if w["workload"] != "edges" and w["peer"] and
             w["peer"]["speed"]["median"] < 1]
    often = f" (most often {max(sorted(set(peers)), key=peers.count)})" if peers else ""
    return words(["A peer", often, " in ", f.n("error", "peer_wins"), ", Overcast, certified, in ",
                  f.n("error", "wins"), " of ", f.n("error", "comparisons"), " comparisons: each "
                  "scene "
                  "with camera, shadow and bounced rays, everybody in their fastest setting."])


def exact(f):
    at = ("stiff", "sums", "embree_robust")
    return words(["Overcast, certified: ", f.n("scoreboard", "exact", "median"), " wrong of ",
                  f.n("scoreboard", "exact", "rays"), " rays, by exact arithmetic; Embree robust, "
                  "the "
                  "best peer, had ", f.n(*at, "wrong"), " wrong and ", f.n(*at, "leaks"),
                  " leaked on the extreme cases, its ties not counted."]) \
        if f.at("scoreboard", "exact") else words(["not measured."])


def budget(f):
    if not f.at("error", "budget"):
        return words(["not measured."])
    return words([
        "With ", f.n("error", "budget", "share"), " % of the pages on the GPU a frame of ",
        f.at("error", "budget", "scene"), " takes ", f.n("error", "budget", "time", "median"),
        " times as long (", f.range("error", "budget", "time"), "), and ",
        f.n("error", "budget", "pixels"), " pixels change."])


def left_out(f):
    best = f.at("left-out", "best")
    if not best:
        return words(["not measured."])
    i = f.at("left-out", "rows").index(best)
    names = sorted({row["what"] for row in f.at("left-out", "rows") if row["saved"]["low"] > 0})
    return words([listed(names) if names else "nothing that saved time in every pair of runs",
                  "; most is saved by ", best["what"], " on ", best["scene"], ": ",
                  f.n("left-out", "rows", i, "saved", "median"), " % of the CPU time."])


def machine(f):
    about = f.at("about")
    return words([about["processor"] or "an unnamed processor", ", ", f.n("about", "threads"),
                  " threads; the GPU's part by ", about["renderer"] or "none", "; other programs "
                  "used "
                  "up to ", f.n("about", "others"), " cores meanwhile, and ", f.n("about", "noisy"),
                  " of ", f.n("about", "runs"), f" runs are marked noisy. The {about['form']} "
                  f"form, "
                  f"{about['date']}, Overcast {about['program']}."])


def answers(f):
    return [("Who is fastest?", fastest(f)), ("Who is exact?", exact(f)),
            ("What does a budget cost?", budget(f)), ("What was left out?", left_out(f)),
            ("On which machine?", machine(f))]
