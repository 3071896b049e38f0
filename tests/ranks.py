# SPDX-License-Identifier: Apache-2.0
"""Renders and traces with several ranks under mpirun: the bits of one process, whatever they share;
and where a rank is killed or hangs, a sentence, an end, and a film that goes on to the same bytes.

usage: ranks.py OVERCAST            some of it, for the gate
       ranks.py OVERCAST --faults LIBRARY   MPI fails; LIBRARY: of tests/faults/failing_mpi.c
       ranks.py OVERCAST --all      1, 2, 3, 4, 8 ranks, four scenes, shared or not, two budgets
       ranks.py OVERCAST --kills N  a rank is killed at N random moments
       ranks.py OVERCAST --cost     speed and memory of 2 ranks of a thread against 1 of two
       ranks.py EXAMPLE --example LIBRARY   the C example with 1, 2 and 3 ranks
       ranks.py HOST --absent LIBRARY       a rank never comes to commit; HOST: faults/absent_rank.c
"""
import filecmp
import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

MPIRUN = ["mpirun", "--oversubscribe", "--bind-to", "none"]
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_mpi_yield_when_idle="1")
MOVING = """camera { location <0,2,-6> look_at 0 }
light_source { <5,8,-5> rgb 1 }
plane { y, -1 pigment { checker rgb 1 rgb 0.3 } }
sphere { <2*clock-1,0,0>, 0.7 pigment { rgb x } finish { reflection 0.3 } }
box { <-2,-1,1>, <-1.2,0.3,1.6> translate clock*z pigment { rgb z } }
"""
PATH_BOX = ["box", "--integrator", "path"]


def fail(what):
    sys.exit(f"ranks.py: {what}")


def run(ranks, command, wanted=0, **options):
    """Runs a command on so many ranks, 0 for a process without mpirun."""
    started = MPIRUN + ["-n", str(ranks)] if ranks else []
    done = subprocess.run(started + command, capture_output=True, text=True, env=ENVIRONMENT,
                          timeout=600, **options)
    if wanted is not None and done.returncode != wanted:
        fail(f"{' '.join(command)} on {ranks} ranks: exit {done.returncode}, expected {wanted}\n"
             f"{done.stderr}")
    return done


def same(a, b, what):
    if not filecmp.cmp(a, b, shallow=False):
        fail(f"{what}: the picture is another")


def compare_pictures(overcast, folder, scenes, counts, budgets):
    """Each scene on so many ranks, shared out and not, under each budget."""
    for number, scene in enumerate(scenes):
        render = [overcast, "render", *scene, "-q"]
        alone = folder / f"{number}.png"
        run(0, render + ["-o", str(alone)])
        for ranks in counts:
            for own in ("share", "all"):
                for budget in budgets:
                    picture = folder / "ranks.png"
                    run(ranks, render + ["-o", str(picture), "--ranks-own", own] + budget)
                    what = f"{scene[0]}, {ranks} ranks, {own} {' '.join(budget)}"
                    same(alone, picture, what)
                    print(f"same: {what}", flush=True)


def compare_hits(overcast, folder, scene, counts):
    """Hits of random rays, from the scene and from a file of it that every rank reads in part."""
    random.seed(5)
    rays = "".join(" ".join(str(random.uniform(-20, 20)) for _ in range(6)) + "\n"
                   for _ in range(5000))
    whole = run(0, [overcast, "trace", scene], input=rays).stdout
    # Each rank opens the file: mpirun of Open MPI 5.0.7 doubles or drops parts of its own input.
    file = folder / "rays.txt"
    file.write_text(rays)
    from_file = ["sh", "-c", 'exec "$@" < "$0"', str(file)]
    stored = folder / "scene.ovc"
    run(0, [overcast, "convert", scene, str(stored), "--leaves", "40"])
    for ranks in counts:
        for source in (scene, str(stored)):
            for own in ("share", "all"):
                hits = run(ranks, from_file + [overcast, "trace", source, "--ranks-own",
                                               own]).stdout
                if hits != whole:
                    fail(f"{source}, {ranks} ranks, {own}: hits differ")
        print(f"same: hits of {scene} and of its file, {ranks} ranks", flush=True)
        refused = run(ranks, [overcast, "trace", str(stored), "--ranks-own", "share"], wanted=1,
                      input="no ray\n")
        if "line 1" not in refused.stderr:
            fail(f"no ray: {refused.stderr}")


def side_by_side(*commands):
    """Runs commands as the ranks of one job."""
    job = list(MPIRUN)
    for number, command in enumerate(commands):
        job += ([":"] if number else []) + ["-n", "1", *command]
    return subprocess.run(job, capture_output=True, text=True, env=ENVIRONMENT, timeout=60)


def compare_unequal(overcast, folder):
    """Ranks of other budgets render one picture; ranks of another command, picture, scene or config
    are told so."""
    alone, picture = folder / "alone.png", folder / "unequal.png"
    render = [overcast, "render", "terrain-60", "-q", "--size", "64x48"]
    run(0, render + ["-o", str(alone)])
    render += ["-o", str(picture), "--rank-timeout", "10"]
    share = render + ["--ranks-own", "share"]
    for first, second in ((["100M"], ["400K"]), (["300K"], ["100M"])):
        for begin in (render, share):
            done = side_by_side(begin + ["--gpu-memory"] + first, begin + ["--gpu-memory"] + second)
            if done.returncode:
                fail(f"budgets {first} and {second}: exit {done.returncode}\n{done.stderr}")
            same(alone, picture, f"budgets {first} and {second}")
    knot = [overcast, "render", "knot", *render[3:]]
    for one, other, sentence in (
            (render, [overcast, "trace", "terrain-60"], "it has another command than rank 0"),
            (render, render + ["--crop", "32x32+0+0"], "it has another picture than rank 0"),
            (render, render + ["--samples", "4"], "it has another picture than rank 0"),
            (share, render + ["--ranks-own", "all"], "has a config other than that of rank 0"),
            (render, knot, "all ranks of a scene need the same meshes"),
            (share, share + ["--camera", "0,9,9,0,0,0"], "the leaves of this rank")):
        done = side_by_side(one, other)
        if done.returncode == 0 or sentence not in done.stderr:
            fail(f"{other}: exit {done.returncode}, and not: {sentence}\n{done.stderr}")
    print("same: the picture of ranks that have other budgets; what is not alike is refused")


def compare_layers(overcast, folder):
    """The first rank traces layers of a frame; the others move on only then."""
    (folder / "moving.pov").write_text(MOVING)
    render = [overcast, "render", str(folder / "moving.pov"), "-q", "--frames", "1:3", "--size",
              "160x160", "--aov", "depth,id,normal,albedo"]
    run(0, render + ["-o", str(folder / "alone-#.exr")])
    run(3, render + ["-o", str(folder / "layers-#.exr"), "--ranks-own", "share"])
    for frame in (1, 2, 3):
        run(0, [overcast, "diff", str(folder / f"alone-{frame}.exr"),
                str(folder / f"layers-{frame}.exr")])
    print("same: layers of frames in which something moves, 3 ranks")


def processes_of(word):
    """Returns the ids of the processes whose command line has the word, except for mpirun's."""
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            line = (entry / "cmdline").read_bytes().decode(errors="replace").split("\0")
        except OSError:
            continue
        if word in line and pathlib.Path(line[0]).name.startswith("overcast"):
            found.append(int(entry.name))
    return sorted(found)


def rank_of(process):
    entries = pathlib.Path(f"/proc/{process}/environ").read_bytes().split(b"\0")
    return int(next(e for e in entries if e.startswith(b"OMPI_COMM_WORLD_RANK=")).split(b"=")[1])


def end_by_force(overcast, folder, whole, deadly, ranks, seconds, scene):
    """Kills or stops a rank after so many seconds. Returns its number and whether a film was kept;
    None where it did not come to that."""
    picture = folder / "killed.png"
    for left in folder.glob("killed*"):
        left.unlink()
    render = [overcast, "render", *scene, "-q", "-o", str(picture)]
    job = subprocess.Popen(MPIRUN + ["-n", str(ranks)] + render +
                           ["--ranks-own", "share", "--rank-timeout", "3", "--save-every", "0"],
                           stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                           env=ENVIRONMENT)
    time.sleep(seconds)
    those = processes_of(str(picture))
    if len(those) < ranks or job.poll() is not None:
        job.communicate()
        return None
    victim = random.choice(those)
    try:
        rank = rank_of(victim)
        os.kill(victim, deadly)
    except OSError:  # it has just ended
        job.communicate()
        return None
    begun = time.monotonic()
    try:
        _, said = job.communicate(timeout=30)
    except subprocess.TimeoutExpired:
        fail(f"signal {deadly} after {seconds:.2f} s: 30 s later the job is there")
    took = time.monotonic() - begun
    if picture.exists():  # it was done already
        same(whole, picture, f"signal {deadly} after {seconds:.2f} s")
        return None
    if job.returncode == 0 or took > 10 + (3 if deadly == signal.SIGSTOP else 0):
        fail(f"signal {deadly}: exit {job.returncode} after {took:.1f} s\n{said}")
    if not re.search(r"rank \d+ .*on ", said):
        fail(f"signal {deadly}: no sentence names the rank\n{said}")
    film = folder / "killed.unfinished.film"
    kept = film.exists()
    run(random.choice([0, 2, 4]), render + ["--continue"])
    same(whole, picture, f"continued after signal {deadly} at {seconds:.2f} s, film {kept}")
    print(f"rank {rank} of {ranks}, signal {deadly} after {seconds:.2f} s: ended in {took:.1f} s, "
          f"{'went on with its film' if kept else 'nothing was saved'}", flush=True)
    return rank, kept


def kill_ranks(overcast, folder, count, scene):
    whole = folder / "whole.png"
    begun = time.monotonic()
    run(3, [overcast, "render", *scene, "-q", "-o", str(whole), "--ranks-own", "share"])
    length = time.monotonic() - begun
    done = []
    while len(done) < count:
        deadly = signal.SIGSTOP if len(done) % 10 == 9 else signal.SIGKILL
        ended = end_by_force(overcast, folder, whole, deadly, random.choice([2, 3, 4]),
                             random.uniform(0.3, length), scene)
        done += [ended] if ended else []
    first = [kept for rank, kept in done if rank == 0]
    print(f"{count} ranks killed or stopped, {len(first)} of them rank 0: each job has ended, and "
          f"each picture is the same; a film was there {sum(kept for _, kept in done)} times, "
          f"{sum(first)} times of rank 0's")


def fail_to_send(overcast, folder, library, scene):
    """In one rank, MPI does not send from a certain message on: that rank says so, the job ends."""
    render = [overcast, "render", *scene, "-q", "-o", str(folder / "unsent.png"), "--ranks-own",
              "share", "--rank-timeout", "3"]
    for rank, message in ((0, 20), (1, 1), (1, 20)):
        preload = ["env", f"LD_PRELOAD={library}", f"OVC_FAULT={rank}:{message}"]
        begun = time.monotonic()
        done = run(2, preload + render, wanted=None)
        took = time.monotonic() - begun
        what = f"message {message} of rank {rank} is not sent"
        if done.returncode == 0 or took > 30:
            fail(f"{what}: exit {done.returncode} after {took:.1f} s\n{done.stderr}")
        if f"MPI cannot send to rank {1 - rank} on " not in done.stderr:
            fail(f"{what}: no sentence tells\n{done.stderr}")
        print(f"{what}: ended in {took:.1f} s", flush=True)


def measure(overcast, folder):
    """Prints the speed of ranks that built a scene, and the memory of those that read its file."""
    stats = folder / "stats.json"

    def render(scene, label, ranks, more):
        run(ranks, [overcast, "render", scene, "-q", "--size", "1600x1200", "-o",
                    str(folder / f"{label}.png"), "--stats", str(stats), *more])
        same(folder / "alone.png", folder / f"{label}.png", f"{scene}, {label}")
        return json.loads(stats.read_text())

    for name in ("dragons-10", "plants-10"):
        seconds = {}
        for _ in range(3):
            for label, ranks, more in (("alone", 0, ["--threads", "2"]),
                                       ("share", 2, ["--threads", "1", "--ranks-own", "share"]),
                                       ("all", 2, ["--threads", "1", "--ranks-own", "all"])):
                told = render(name, label, ranks, more)
                seconds.setdefault(label, []).append(told["time"]["render"])
        best = {label: min(of) for label, of in seconds.items()}
        print(f"{name}: alone {best['alone']:.2f} s; speed of 2 ranks shared "
              f"{best['alone'] / best['share']:.2f}, replicated "
              f"{best['alone'] / best['all']:.2f}", flush=True)
        stored = str(folder / f"{name}.ovc")
        run(0, [overcast, "convert", name, stored, "--leaves", "100"])
        alone = render(stored, "alone", 0, ["--host-memory", "100G"])
        for ranks in (2, 4):
            told = render(stored, "share", ranks, ["--ranks-own", "share"])
            for key in ("host_peak_bytes", "gpu_peak_bytes"):
                peak = max(rank[key] for rank in told["of_ranks"])
                bound = 1.25 * alone[key] / ranks + (64 << 20)
                print(f"{name}, {ranks} ranks: {key} {peak / 2**20:.0f} MiB, at most "
                      f"{bound / 2**20:.0f} of {alone[key] / 2**20:.0f} MiB wanted", flush=True)


def compare_example(example, library):
    pictures = [run(ranks, [example, library]).stdout for ranks in (1, 2, 3)]
    if not pictures[0].strip() or any(p != pictures[0] for p in pictures):
        fail(f"the example draws other pictures on other numbers of ranks\n{pictures[0]}")
    print("same: the example's picture on 1, 2 and 3 ranks")


def miss_a_rank(host, library):
    begun = time.monotonic()
    said = run(2, [host, library], wanted=None).stdout
    took = time.monotonic() - begun
    if "no device" in said:
        print("skipped: no device for the plugin")
        return 77
    if not re.search(r"commit: 7: rank 0 on .* has waited 1 s for another rank", said) or \
            "destroyed" not in said or took > 30:
        fail(f"a rank that never comes to commit, after {took:.1f} s: {said}")
    print(f"a rank that never comes to commit: an error, and all ended in {took:.1f} s")
    return 0


def main():
    overcast, *mode = sys.argv[1:]
    if not shutil.which("mpirun"):
        print("mpirun is not installed")
        return 77
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        if mode[:1] == ["--example"]:
            compare_example(overcast, mode[1])
        elif mode[:1] == ["--absent"]:
            return miss_a_rank(overcast, mode[1])
        elif mode[:1] == ["--kills"]:
            kill_ranks(overcast, folder, int(mode[1]),
                       PATH_BOX + ["--samples", "64", "--size", "160x160"])
        elif mode[:1] == ["--faults"]:
            fail_to_send(overcast, folder, mode[1],
                         PATH_BOX + ["--samples", "16", "--size", "64x64"])
        elif mode == ["--cost"]:
            measure(overcast, folder)
        elif mode == ["--all"]:
            scenes = [["plants-5", "--size", "256x256"], ["dragons-10", "--size", "256x256"],
                      ["fractal", "--size", "256x256"],
                      PATH_BOX + ["--samples", "16", "--size", "128x128"]]
            for scene, small in zip(scenes, ("16M", "60M", "12M", "1M")):
                compare_pictures(overcast, folder, [scene], (1, 2, 3, 4, 8),
                                 [[], ["--gpu-memory", small]])
            compare_hits(overcast, folder, "plants-5", (1, 2, 3, 4, 8))
        else:
            compare_pictures(overcast, folder,
                             [["knot", "--size", "96x96", "--antialias", "0.3"],
                              PATH_BOX + ["--samples", "4", "--size", "48x48"]], (2,),
                             [["--gpu-memory", "16M"]])
            compare_hits(overcast, folder, "terrain-60", (3,))
            compare_unequal(overcast, folder)
            compare_layers(overcast, folder)
            kill_ranks(overcast, folder, 1, PATH_BOX + ["--samples", "16", "--size", "128x128"])
    return 0


if __name__ == "__main__":
    sys.exit(main())
