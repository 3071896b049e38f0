# SPDX-License-Identifier: Apache-2.0
"""Measures ranks on this machine, checks the model of scale against them, and predicts larger jobs.

usage: scale.py measure OVERCAST SCENE RATES.json [--size WxH] [--repeats N]
                                          runs 1, 2, 4, 8 ranks of a thread
       scale.py check RATES.json          simulated beside measured; exit 1 above 20 %
       scale.py predict RATES.json        frames of up to 1e11 triangles on up to 1,000 ranks
"""
import argparse
import dataclasses
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

import model

COUNTS = (1, 2, 4, 8)
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_mpi_yield_when_idle="1")


def run_once(overcast, scene, size, ranks, folder):
    stats = folder / "stats.json"
    command = [overcast, "render", scene, "-q", "--size", size, "--threads", "1", "-o",
               str(folder / "picture.png"), "--stats", str(stats)]
    if ranks > 1:
        command = (["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(ranks)] + command +
                   ["--ranks-own", "share"])
    subprocess.run(command, check=True, env=ENVIRONMENT)
    return rates_of(json.loads(stats.read_text()), ranks)


def rates_of(told, ranks):
    """What the model wants to know of the statistics of a picture by so many ranks."""
    rays = told["rays"]
    total = sum(rays.values())
    sent = sum(r["rays_sent"] for r in told["of_ranks"])
    return {"seconds": told["time"]["render"], "trace": told["time"]["trace"],
            "shade": told["time"]["shade"], "triangles": told["triangles"],
            "rays": [rays["primary"], rays["shadow"],
                     rays["reflection"] + rays["refraction"] + rays["bounce"]],
            # Stops are spread over all ranks, this one among them.
            "visits_per_ray": max(1.0, sent / total * ranks / (ranks - 1)) if ranks > 1 else 1.0,
            "imbalance": told["imbalance"],
            "bytes_per_visit": sum(r["bytes_sent"] for r in told["of_ranks"]) / max(sent, 1)}


def measure(arguments):
    runs = {}
    with tempfile.TemporaryDirectory() as name:
        for _ in range(arguments.repeats):  # in turn, so that a busy moment hits all alike
            for ranks in COUNTS:
                runs.setdefault(ranks, []).append(run_once(
                    arguments.overcast, arguments.scene, arguments.size, ranks,
                    pathlib.Path(name)))
    best = {str(ranks): min(of, key=lambda r: r["seconds"]) for ranks, of in runs.items()}
    spread = {str(ranks): statistics.pstdev(r["seconds"] for r in of) for ranks, of in runs.items()}
    document = {"scene": pathlib.Path(arguments.scene).name, "size": arguments.size,
                "cores": len(os.sched_getaffinity(0)), "runs": best, "spread": spread}
    pathlib.Path(arguments.rates).write_text(json.dumps(document, indent=1) + "\n")


def job_of(run, ranks):
    return model.Job(ranks=ranks, rays=run["rays"], visits_per_ray=run["visits_per_ray"],
                     imbalance=run["imbalance"])


def fitted(rates):
    """The machine whose one and two ranks take what was measured; more ranks are not fitted."""
    alone, two = rates["runs"]["1"], rates["runs"]["2"]
    total = sum(alone["rays"])
    machine = model.Machine(cores=rates["cores"], shade_seconds=alone["shade"] / total,
                            home_seconds=0, message_seconds=2e-5, batch_seconds=2e-3)

    def seconds(visit, run, ranks, home):
        on = dataclasses.replace(machine, visit_seconds=visit, ranks_per_node=ranks,
                                 home_seconds=home)
        return model.simulate(on, job_of(run, ranks))[0]

    def solve(of, wanted):
        low, high = 0.0, 1e-4
        for _ in range(40):
            middle = (low + high) / 2
            low, high = (middle, high) if of(middle) < wanted else (low, middle)
        return low

    visit = solve(lambda x: seconds(x, alone, 1, 0), alone["seconds"])
    home = solve(lambda x: seconds(visit, two, 2, x), two["seconds"])
    return dataclasses.replace(machine, visit_seconds=visit, home_seconds=home)


def check(arguments):
    rates = json.loads(pathlib.Path(arguments.rates).read_text())
    machine = fitted(rates)
    print(f"{rates['scene']}, {rates['size']}, {rates['cores']} cores: a visit "
          f"{machine.visit_seconds * 1e6:.2f} us of the server and "
          f"{machine.home_seconds * 1e6:.2f} us at home")
    print("| ranks | visits a ray | busiest share | measured s | simulated s | off |")
    print("|---:|---:|---:|---:|---:|---:|")
    wrong = False
    for ranks in COUNTS:
        run = rates["runs"][str(ranks)]
        on = dataclasses.replace(machine, ranks_per_node=ranks)
        if ranks == 1:  # a process by itself sends nothing
            on = dataclasses.replace(on, home_seconds=0)
        seconds, _ = model.simulate(on, job_of(run, ranks))
        off = seconds / run["seconds"] - 1
        wrong = wrong or abs(off) > 0.2
        print(f"| {ranks} | {run['visits_per_ray']:.2f} | {run['imbalance']:.2f} | "
              f"{run['seconds']:.2f} | {seconds:.2f} | {100 * off:+.0f} % |")
    return 1 if wrong else 0


def visits_at(rates, ranks):
    """Visits a ray, extended by the cube root of ranks, as blocks of a volume lie on a line."""
    runs = rates["runs"]
    slope = statistics.mean((run["visits_per_ray"] - 1) / (int(n) ** (1 / 3) - 1)
                            for n, run in runs.items() if int(n) > 1)
    return 1 + slope * (ranks ** (1 / 3) - 1)


def predict(arguments):
    rates = json.loads(pathlib.Path(arguments.rates).read_text())
    machine = fitted(rates)
    alone = rates["runs"]["1"]
    imbalance = rates["runs"]["8"]["imbalance"]
    print(f"A picture of {arguments.pixels:.2g} pixels with the rays a pixel of {rates['scene']}; "
          f"a device that traces {arguments.rate:.2g} visits a second, a network of "
          f"{arguments.bandwidth:.2g} bytes/s, a disk of {arguments.disk:.2g} bytes/s. Half of a "
          f"share that exceeds the {arguments.memory:.2g} bytes of host memory of a rank is read.")
    print("| triangles | ranks | visits a ray | s a picture | Mrays/s | limited by |")
    print("|---:|---:|---:|---:|---:|---|")
    scale = arguments.pixels / alone["rays"][0]
    for triangles in (1e8, 1e9, 1e10, 1e11):
        for ranks in (1, 8, 64, 1000):
            share = triangles * arguments.bytes_per_triangle / ranks
            read = share * ranks / 2 if share > arguments.memory else 0
            # A tree of more triangles is deeper; the measured scene stands for its own depth.
            deeper = 1 + 0.06 * max(0.0, math.log2(triangles / ranks / alone["triangles"]))
            on = dataclasses.replace(machine, cores=16, ranks_per_node=1,
                                     visit_seconds=deeper / arguments.rate, disk=arguments.disk,
                                     bandwidth=arguments.bandwidth, batch_seconds=2e-4,
                                     message_seconds=2e-6,
                                     home_seconds=machine.home_seconds / 16,
                                     shade_seconds=machine.shade_seconds / 16)
            rays = [count * scale for count in alone["rays"]]
            visits = visits_at(rates, ranks)
            seconds, limit = model.simulate(on, model.Job(ranks, rays, visits, imbalance, read))
            print(f"| {triangles:.0e} | {ranks} | {visits:.1f} | {seconds:.3f} | "
                  f"{sum(rays) / seconds / 1e6:.0f} | {limit} |")
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parts = parser.add_subparsers(required=True)
    part = parts.add_parser("measure")
    part.add_argument("overcast")
    part.add_argument("scene")
    part.add_argument("rates")
    part.add_argument("--size", default="640x480")
    part.add_argument("--repeats", type=int, default=3)
    part.set_defaults(run=measure)
    part = parts.add_parser("check")
    part.add_argument("rates")
    part.set_defaults(run=check)
    part = parts.add_parser("predict")
    part.add_argument("rates")
    part.add_argument("--pixels", type=float, default=1920 * 1080)
    part.add_argument("--rate", type=float, default=2e8, help="visits a second that a rank traces")
    part.add_argument("--bandwidth", type=float, default=2.5e10, help="bytes a second of a node")
    part.add_argument("--disk", type=float, default=5e9, help="bytes a second of a node")
    part.add_argument("--memory", type=float, default=64e9, help="bytes of host memory of a rank")
    part.add_argument("--bytes-per-triangle", type=float, default=65, help="page and corners")
    part.set_defaults(run=predict)
    arguments = parser.parse_args()
    return arguments.run(arguments) or 0


if __name__ == "__main__":
    sys.exit(main())
