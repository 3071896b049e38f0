# SPDX-License-Identifier: Apache-2.0
"""Measures ranks on this machine, checks the model of scale against them, and predicts larger jobs.

usage: scale.py measure OVERCAST SCENE RATES.json [--size WxH] [--repeats N]
                                          runs 1, 2, 4, 8 ranks of a thread
       scale.py check RATES.json [--cpu]  simulated beside measured; exit 1 above 20 %; with --cpu
                                          only CPU seconds count, as on a busy machine
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
    if scene.endswith(".ovc"):
        command += ["--host-memory", "100G"]  # what is read again depends on the budget
    if ranks > 1:
        command = (["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(ranks)] + command +
                   ["--ranks-own", "share"])
    subprocess.run(command, check=True, env=ENVIRONMENT)
    return rates_of(json.loads(stats.read_text()), ranks)


def rates_of(told, ranks):
    """What the model wants to know of the statistics of a picture by so many ranks."""
    rays = sum(told["rays"].values())
    of_ranks = told["of_ranks"] if ranks > 1 else [told]
    served = [r["rays_served"] for r in of_ranks]
    mean = sum(served) / ranks
    # Rank 0 stands for all in statistics that do not tell of each.
    cpu = sum(r["time"].get("cpu", told["time"]["cpu"]) for r in of_ranks)
    return {"seconds": told["time"]["render"], "cpu": cpu,
            "trace": told["time"]["trace"], "shade": told["time"]["shade"],
            "waiting": [r["time"]["waiting"] for r in of_ranks],
            "triangles": told["triangles"], "rays": rays, "primary": told["rays"]["primary"],
            "away_per_ray": sum(r["rays_sent"] for r in of_ranks) / rays,
            "imbalance": max(served) / mean if mean else 1.0}


def measure(arguments):
    runs = {}
    with tempfile.TemporaryDirectory() as name:
        for _ in range(arguments.repeats):  # in turn, so that a busy moment hits all alike
            for ranks in COUNTS:
                runs.setdefault(ranks, []).append(run_once(
                    arguments.overcast, arguments.scene, arguments.size, ranks,
                    pathlib.Path(name)))
    best = {str(ranks): min(of, key=lambda r: r["seconds"]) for ranks, of in runs.items()}
    for ranks, of in runs.items():
        best[str(ranks)]["cpu"] = statistics.median(r["cpu"] for r in of)
    spread = {str(ranks): statistics.pstdev(r["seconds"] for r in of) for ranks, of in runs.items()}
    document = {"scene": pathlib.Path(arguments.scene).name, "size": arguments.size,
                "cores": len(os.sched_getaffinity(0)), "runs": best, "spread": spread}
    pathlib.Path(arguments.rates).write_text(json.dumps(document, indent=1) + "\n")


def job_of(run, ranks):
    return model.Job(ranks=ranks, rays=run["rays"], away_per_ray=run["away_per_ray"],
                     imbalance=run["imbalance"])


def costs_of_sharing(more, away):
    """Returns what a ray and a visit elsewhere take, neither below 0, so that a ray with so many
    visits `away` comes to `more`, by least squares over two runs. Where both send about as many
    rays, nothing tells the two apart, and each has half."""
    ray = max(statistics.mean(more), 0.0)
    if max(away) == 0:
        return ray, 0.0
    if max(away) < 1.5 * min(away):
        return ray / 2, ray / 2 / statistics.mean(away)
    slope = (more[1] - more[0]) / (away[1] - away[0])
    if slope >= 0 and more[0] >= slope * away[0]:
        return more[0] - slope * away[0], slope
    visit = max(sum(m * a for m, a in zip(more, away)) / sum(a * a for a in away), 0.0)

    def off(ray, visit):
        return sum((ray + visit * a - m) ** 2 for m, a in zip(more, away))

    return min((ray, 0.0), (0.0, visit), key=lambda costs: off(*costs))


def fitted(rates):
    """The machine whose one, two and four ranks take the CPU seconds that were measured: what ranks
    take more grows with rays and with visits elsewhere."""
    alone, two, four = (rates["runs"][ranks] for ranks in "124")
    ray = alone["cpu"] / alone["rays"]
    shading = alone["shade"] / (alone["shade"] + alone["trace"])
    # A visit elsewhere costs a visit besides.
    visit = ray * (1 - shading)
    route, elsewhere = costs_of_sharing(
        [(run["cpu"] - alone["cpu"]) / run["rays"] - run["away_per_ray"] * visit
         for run in (two, four)], [run["away_per_ray"] for run in (two, four)])
    return model.Machine(cores=rates["cores"], shade_seconds=ray * shading,
                         visit_seconds=visit, batch_seconds=0.0, away_seconds=elsewhere,
                         route_seconds=route,
                         message_seconds=5e-4)  # threads sleep between looking for messages


def check(arguments):
    rates = json.loads(pathlib.Path(arguments.rates).read_text())
    machine = fitted(rates)
    print(f"{rates['scene']}, {rates['size']}, {rates['cores']} cores: a ray's shading "
          f"{machine.shade_seconds * 1e6:.2f} us, where it goes {machine.route_seconds * 1e6:.2f}, "
          f"a visit {machine.visit_seconds * 1e6:.2f}, and {machine.away_seconds * 1e6:.2f} more "
          "elsewhere")
    print("| ranks | visits elsewhere a ray | busiest share | CPU s | simulated | off | "
          "measured s | simulated s | off |")
    print("|---:|---:|---:|---:|---:|---:|---:|---:|---:|")
    wrong = False
    for ranks in COUNTS:
        run = rates["runs"][str(ranks)]
        on = dataclasses.replace(machine, ranks_per_node=ranks)
        seconds, cpu, _ = model.simulate(on, job_of(run, ranks))
        off, cpu_off = seconds / run["seconds"] - 1, cpu / run["cpu"] - 1
        wrong = wrong or abs(cpu_off) > 0.2 or (abs(off) > 0.2 and not arguments.cpu)
        print(f"| {ranks} | {run['away_per_ray']:.2f} | {run['imbalance']:.2f} | "
              f"{run['cpu']:.2f} | {cpu:.2f} | {100 * cpu_off:+.0f} % | "
              f"{run['seconds']:.2f} | {seconds:.2f} | {100 * off:+.0f} % |")
    return 1 if wrong else 0


def away_at(rates, ranks):
    """Visits elsewhere a ray, extended by the cube root of ranks, as blocks of a volume lie on a
    line."""
    slope = statistics.mean(run["away_per_ray"] / (int(n) ** (1 / 3) - 1)
                            for n, run in rates["runs"].items() if int(n) > 1)
    return slope * (ranks ** (1 / 3) - 1)


def predict(arguments):
    rates = json.loads(pathlib.Path(arguments.rates).read_text())
    machine = fitted(rates)
    alone = rates["runs"]["1"]
    imbalance = rates["runs"]["8"]["imbalance"]
    print(f"A picture of {arguments.pixels:.2g} pixels with the rays a pixel of {rates['scene']}; "
          f"a device that traces {arguments.rate:.2g} visits a second, a network of "
          f"{arguments.bandwidth:.2g} bytes/s, a disk of {arguments.disk:.2g} bytes/s. Half of a "
          f"share that exceeds the {arguments.memory:.2g} bytes of host memory of a rank is read.")
    print("| triangles | ranks | visits elsewhere a ray | s a picture | Mrays/s | limited by |")
    print("|---:|---:|---:|---:|---:|---|")
    rays = alone["rays"] * arguments.pixels / alone["primary"]
    for triangles in (1e8, 1e9, 1e10, 1e11):
        for ranks in (1, 8, 64, 1000):
            share = triangles * arguments.bytes_per_triangle / ranks
            read = share * ranks / 2 if share > arguments.memory else 0
            # A tree of more triangles is deeper; the measured scene stands for its own depth.
            deeper = 1 + 0.06 * max(0.0, math.log2(triangles / ranks / alone["triangles"]))
            on = dataclasses.replace(machine, cores=16, threads=16, ranks_per_node=1,
                                     visit_seconds=deeper / arguments.rate, disk=arguments.disk,
                                     bandwidth=arguments.bandwidth, batch_seconds=2e-4,
                                     message_seconds=2e-6,
                                     # Loops of home and server run on all cores.
                                     away_seconds=machine.away_seconds / 16,
                                     shade_seconds=machine.shade_seconds / 16,
                                     route_seconds=machine.route_seconds / 16)
            away = away_at(rates, ranks)
            seconds, _, limit = model.simulate(on, model.Job(ranks, rays, away, imbalance, read))
            print(f"| {triangles:.0e} | {ranks} | {away:.1f} | {seconds:.3f} | "
                  f"{rays / seconds / 1e6:.0f} | {limit} |")
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
    part.add_argument("--cpu", action="store_true")
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
