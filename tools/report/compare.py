# SPDX-License-Identifier: Apache-2.0
"""Two reports side by side: what changed beyond noise."""
from page import Section, Table, words

LEAST_CHANGE = 0.05


def measured(tree):
    """Yields (name, median, low, high) of everything that has a spread."""
    for scene in tree["error"]["scenes"]:
        for w in scene["workloads"]:
            for c in w["contenders"]:
                if c["family"] in ("certified", "fast"):
                    yield (f"{scene['scene']}, {w['workload']}, {c['name']}: ns",
                           c["ns"]["median"], c["ns"]["low"], c["ns"]["high"])
    if tree["error"]["budget"]:
        time = tree["error"]["budget"]["time"]
        yield "budget: times", time["median"], time["low"], time["high"]
    for row in tree["programs"]["programs"]:
        s = row["seconds"]
        yield f"{row['name']}: s", s["median"], s["low"], s["high"]


def compare_figures(tree, other):
    """A change counts where it is above 5 % and the spreads do not touch."""
    before = {name: values for name, *values in measured(other)}
    rows = []
    for name, median, low, high in measured(tree):
        if name not in before or not before[name][0]:
            continue
        old, old_low, old_high = before[name]
        change = median / old - 1
        beyond = abs(change) > LEAST_CHANGE and (low > old_high or high < old_low)
        rows.append({"name": name, "before": old, "now": median, "percent": 100 * change,
                     "beyond": beyond})
    flags = []
    for key, line in tree["scoreboard"].items():
        was = other["scoreboard"].get(key)
        if line and was and line["verdict"] != was["verdict"]:
            flags.append({"key": key, "before": was["verdict"], "now": line["verdict"]})
    changed = sorted((r for r in rows if r["beyond"]), key=lambda r: -abs(r["percent"]))
    return {"compared": len(rows), "changed": changed, "count": len(changed), "verdicts": flags,
            "other": other["about"]}


def compare_section(f):
    figures = f.at("compare")
    table = Table("What changed beyond noise", ["what", "before", "now", "%"], [
        [row["name"]] + [f.n("compare", "changed", i, k) for k in ("before", "now", "percent")]
        for i, row in enumerate(figures["changed"])])
    verdicts = "; ".join(f"{v['key']} {v['before']} before and {v['now']} now"
                         for v in figures["verdicts"])
    claim = words([f.n("compare", "count"), " of ", f.n("compare", "compared"),
                   " times changed by more than their spreads",
                   f"; {verdicts}" if verdicts else "; no verdict changed", "."])
    about = figures["other"]
    return Section("compare", "Beside another report", claim,
                   f"The other is of {about['date']}, Overcast {about['program']}, "
                   f"{about['processor']}.", tables=[table])
