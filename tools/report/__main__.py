# SPDX-License-Identifier: Apache-2.0
"""Makes the page of a report: DIR/index.html and DIR/page.json, from DIR/NAME.json.

It runs nothing; `overcast report -o DIR` measures, and then calls this.
"""
import argparse
import importlib.util
import json
import os
import pathlib
import sys
import tempfile

DEBIAN = "/usr/bin/python3"  # which the packages are for, also where PATH leads to another Python


def missing_packages():
    return [package for module, package in (("matplotlib", "python3-matplotlib"),
                                            ("jinja2", "python3-jinja2"))
            if importlib.util.find_spec(module) is None]


def write_whole(path, text):
    """The file appears whole, or stays what it was."""
    with tempfile.NamedTemporaryFile("w", dir=path.parent, delete=False, encoding="utf-8") as file:
        file.write(text)
    os.chmod(file.name, 0o644)
    os.replace(file.name, path)


def about(documents):
    """What was measured, on what, and how busy it was."""
    import data
    first = next(iter(documents.values()))
    loads = [data.quiet(document) for document in documents.values()]
    renderer = next((c["renderer"] for document in documents.values()
                     for run in data.Runs(document).all
                     for s in run["result"].get("scenes", []) if isinstance(s, dict)
                     for c in s.get("contenders", []) if c["renderer"]), "")
    return {"form": first["form"], "date": first["date"], "program": first["program"],
            "processor": first["machine"]["processor"], "threads": first["machine"]["threads"],
            "system": first["machine"]["system"], "renderer": renderer,
            "runs": sum(load["runs"] for load in loads), "noisy": sum(l["noisy"] for l in loads),
            "repeated": sum(load["repeated"] for load in loads),
            "others": max(load["others"] for load in loads)}


def troubles_of(documents):
    return [f"{name}, {run['key']}: {run['trouble']}" for name, document in documents.items()
            for run in document["runs"] if run["trouble"]]


def figures_of(folder):
    import accuracy, cost, data, machines, scoreboard, thesis  # noqa: E401
    documents = data.load(folder)
    if not documents:
        raise data.Problem(f"{folder} has no experiment; measure with: overcast report -o {folder}")
    tree = {"schema": "overcast-page-1", "about": about(documents),
            "error": accuracy.error_figures(documents), "stiff": accuracy.stiff_figures(documents),
            "left-out": cost.left_out_figures(documents), "growth": cost.growth_figures(documents),
            "memory": cost.memory_figures(documents),
            "machines": machines.machines_figures(documents),
            "thesis": thesis.thesis_figures(documents),
            "pictures": thesis.pictures_figures(documents),
            "programs": scoreboard.programs_figures(documents),
            "troubles": troubles_of(documents),
            "load": {name: data.quiet(document) for name, document in documents.items()}}
    tree["scoreboard"] = scoreboard.scoreboard_figures(tree)
    return documents, tree


def sections_of(documents, figures, folder):
    """The sections whose experiments are there, in the order of the page."""
    import accuracy, cost, data, machines, page, thesis  # noqa: E401
    made = []
    for names, section in (
            (("error", "samples", "tessellation", "programs"), accuracy.error_section),
            (("stiff",), accuracy.stiff_section), (("left-out",), cost.left_out_section),
            (("growth",), cost.growth_section), (("memory",), cost.memory_section),
            (("machines",), machines.machines_section), (("thesis",), thesis.thesis_section),
            (("pictures",), lambda f: thesis.pictures_section(f, folder))):
        there = [documents[name] for name in names if name in documents]
        if not any(data.Runs(document) for document in there):
            continue
        one = section(figures)
        one.again = [document["again"] for document in there]
        load = [page.words([figures.n("load", d["experiment"], "noisy"), " of ",
                            figures.n("load", d["experiment"], "runs"), " runs of ",
                            d["experiment"], " noisy",
                            "" if d["complete"] else ", and others missing"]) for d in there]
        one.load = page.words([page.listed(load), "."])
        made.append(one)
    return made


def make(folder, other=None, kit=None):
    import compare, machines, page, scoreboard  # noqa: E401
    documents, tree = figures_of(folder)
    if kit:
        tree["gpu"] = machines.gpu_figures(kit)
    if other:
        tree["compare"] = compare.compare_figures(tree, figures_of(other)[1])
    figures = page.Figures(tree)
    sections = sections_of(documents, figures, folder)
    if kit:
        sections.append(machines.gpu_section(figures))
    if other:
        sections.append(compare.compare_section(figures))
    html = page.render(answers=scoreboard.answers(figures), troubles=tree["troubles"],
                       scoreboard=scoreboard.scoreboard_lines(figures), sections=sections)
    write_whole(pathlib.Path(folder) / "page.json", json.dumps(tree, indent=1) + "\n")
    write_whole(pathlib.Path(folder) / "index.html", html)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", help="of a report; its page is written there")
    parser.add_argument("--compare", metavar="DIR", help="another report, put beside this one")
    parser.add_argument("--kit", metavar="FILE", help="the kit.json of a machine with a GPU")
    arguments = parser.parse_args()
    missing = missing_packages()
    if missing and os.path.exists(DEBIAN) and os.path.realpath(sys.executable) != \
            os.path.realpath(DEBIAN):
        os.execv(DEBIAN, [DEBIAN, "-B", *sys.argv])
    if missing:
        return f"not installed: {' '.join(missing)}; apt install {' '.join(missing)}"
    import data
    try:
        make(arguments.folder, arguments.compare, arguments.kit)
    except (data.Problem, OSError) as problem:
        return str(problem)
    return 0


if __name__ == "__main__":
    sys.exit(main())
