# SPDX-License-Identifier: Apache-2.0
"""A model of ranks that share a scene out: a discrete-event simulation of a picture's rays.

Each rank has a home, which begins batches of rays and shades their answers, a server, which traces
what visits it, and a transport. Home and server want cores of the rank's node, the transport its
network. The rays of a batch visit their own rank, and a part of them others; the next batch begins
when all answers are there and shaded, while others are under way. What is simulated follows
docs/decisions/0031; rates are measured (scale.py).
"""
import dataclasses
import heapq
import itertools
import math

# As in plugin/ranks/routed_stream.cpp and visit_server.cpp, of which the last two are a thread's.
BATCHES = 4
MIN_BATCH, MAX_BATCH, BATCH_A_THREAD = 7 << 10, 1 << 17, 7 << 9
SERVER_BATCH_A_THREAD = 1 << 13
VISIT_BYTES, ANSWER_BYTES = 72, 32
MAX_SIMULATED = 16     # ranks; of more, so many stand for all


@dataclasses.dataclass
class Machine:
    """What a rank runs on. Seconds are of one core, unless a device is said to trace."""
    cores: int = 2                 # of a node
    ranks_per_node: int = 1
    threads: int = 1               # of a rank
    visit_seconds: float = 1e-6    # of the server, a visit that it traces
    batch_seconds: float = 2e-4    # of the server, a batch, besides its visits
    away_seconds: float = 1e-6     # of home and server together, a visit elsewhere, besides tracing
    shade_seconds: float = 1e-7    # of the home, a ray
    route_seconds: float = 0.0     # of the home, a ray of a shared scene: where it goes
    message_seconds: float = 2e-6  # of latency, a message
    message_cpu: float = 1e-6      # of the home, a message
    bandwidth: float = 1e10        # bytes a second, of a node each way; no limit within a node
    disk: float = 2e9              # bytes a second, of a node


@dataclasses.dataclass
class Job:
    """A picture of so many rays, over all ranks."""
    ranks: int
    rays: float
    away_per_ray: float            # visits to other ranks
    imbalance: float = 1.0         # the busiest rank's visits of others to the mean
    disk_bytes: float = 0          # that are read, over all ranks


class Resource:
    """So many servants; what is asked for begins when one is free, first come, first served."""

    def __init__(self, count):
        self.free = [0.0] * count
        self.busy = 0.0

    def take(self, now, seconds):
        begin = max(now, heapq.heappop(self.free))
        heapq.heappush(self.free, begin + seconds)
        self.busy += seconds
        return begin + seconds


class Batch:
    """Rays of a home under way, and the messages of them that have not come back."""

    def __init__(self, rays):
        self.rays, self.messages = rays, 0


class Rank:
    def __init__(self, rays, unread):
        self.rays_left, self.unread = rays, unread
        self.batches = 0           # under way
        self.home_free = 0.0       # the home is one thread
        self.waiting = []          # (home, batch, visits), which the server traces next
        self.serving = False
        self.end = 0.0


class Simulation:
    def __init__(self, machine, job):
        self.machine, self.job = machine, job
        self.shown = min(job.ranks, MAX_SIMULATED)
        self.events, self.order, self.now = [], itertools.count(), 0.0
        nodes = math.ceil(self.shown / machine.ranks_per_node)
        self.cores = [Resource(machine.cores) for _ in range(nodes)]
        self.network = [Resource(1) for _ in range(nodes)]
        self.disks = [Resource(1) for _ in range(nodes)]
        self.ranks = [Rank(job.rays / job.ranks, job.disk_bytes / job.ranks)
                      for _ in range(self.shown)]
        mean = (job.ranks - job.imbalance) / max(job.ranks - 1, 1)
        self.weights = [job.imbalance if rank == 0 else mean for rank in range(self.shown)]
        self.batch_rays = min(max(BATCH_A_THREAD * machine.threads, MIN_BATCH), MAX_BATCH)

    def node(self, rank):
        return rank // self.machine.ranks_per_node

    def at(self, time, what, *arguments):
        heapq.heappush(self.events, (time, next(self.order), what, arguments))

    def run(self):
        """Returns the seconds of the picture, of its cores together, and what limits it."""
        for rank in range(self.shown):
            for _ in range(BATCHES):
                self.begin(rank)
        while self.events:
            self.now, _, what, arguments = heapq.heappop(self.events)
            what(*arguments)
        seconds = max(rank.end for rank in self.ranks)
        used = {"cores": max(r.busy / len(r.free) for r in self.cores),
                "network": max(r.busy for r in self.network),
                "disk": max(r.busy for r in self.disks)}
        limit = max(used, key=used.get)
        return (seconds, sum(r.busy for r in self.cores) * self.job.ranks / self.shown,
                limit if used[limit] > 0.5 * seconds else "waiting")

    def at_home(self, rank, seconds):
        """Returns when the home has worked for so long, on one core."""
        home = self.ranks[rank]
        home.home_free = self.cores[self.node(rank)].take(max(self.now, home.home_free), seconds)
        return home.home_free

    def begin(self, rank):
        home = self.ranks[rank]
        rays = min(self.batch_rays, home.rays_left)
        if rays < 1e-9:
            home.end = self.now
            return
        home.rays_left -= rays
        self.at(self.now, self.arrive, rank, rank, Batch(rays), rays)

    def arrive(self, other, home, batch, visits):
        # Those of others go first.
        waiting = self.ranks[other].waiting
        place = len(waiting) if home == other else sum(1 for w in waiting if w[0] != other)
        waiting.insert(place, (home, batch, visits))
        self.serve(other)

    def serve(self, number):
        rank, machine = self.ranks[number], self.machine
        if rank.serving or not rank.waiting:
            return
        rank.serving = True
        taken, visits, away = [], 0.0, 0.0
        while rank.waiting and (not taken or visits + rank.waiting[0][2] <=
                                SERVER_BATCH_A_THREAD * machine.threads):
            taken.append(rank.waiting.pop(0))
            visits += taken[-1][2]
            away += taken[-1][2] if taken[-1][0] != number else 0
        begun = self.now
        if rank.unread > 0:  # pages of the share come from the disk once
            part = min(rank.unread, self.job.disk_bytes / self.job.ranks / 8)
            rank.unread -= part
            begun = self.disks[self.node(number)].take(self.now, part / machine.disk)
        seconds = (machine.batch_seconds + visits * machine.visit_seconds +
                   away * machine.away_seconds / 2)
        done = self.cores[self.node(number)].take(begun, seconds)
        self.at(done, self.served, number, taken)

    def served(self, number, taken):
        self.ranks[number].serving = False
        for home, batch, visits in taken:
            if home == number:
                self.send_away(home, batch)
            else:
                self.send(self.now, number, home, visits * ANSWER_BYTES, self.come_home, home,
                          batch)
        self.serve(number)

    def send_away(self, home, batch):
        """Sends a part of a batch's rays to other ranks, by the weights of their shares."""
        visits = batch.rays * self.job.away_per_ray if self.job.ranks > 1 else 0
        total = sum(w for rank, w in enumerate(self.weights) if rank != home)
        for other in range(self.shown):
            count = visits * self.weights[other] / total if total and other != home else 0
            if count < 1e-9:
                continue
            batch.messages += 1
            # One simulated rank stands for several, each of which gets a message of its own.
            messages = max(1.0, min(count, self.job.ranks / self.shown))
            done = self.at_home(home, count * self.machine.away_seconds / 2 +
                                messages * self.machine.message_cpu)
            self.send(done, home, other, count * VISIT_BYTES, self.arrive, other, home, batch,
                      count)
        if batch.messages == 0:
            self.shade(home, batch)

    def send(self, now, sender, to, size, then, *arguments):
        if self.node(sender) != self.node(to):
            now = self.network[self.node(sender)].take(now, size / self.machine.bandwidth)
        self.at(now + self.machine.message_seconds, then, *arguments)

    def come_home(self, home, batch):
        batch.messages -= 1
        if batch.messages == 0:
            self.shade(home, batch)

    def shade(self, home, batch):
        seconds = self.machine.shade_seconds
        if self.job.ranks > 1:
            seconds += self.machine.route_seconds
        self.at(self.at_home(home, batch.rays * seconds), self.begin, home)


def simulate(machine, job):
    """Returns (seconds of the picture, of its cores together, what limits it: cores, network, disk
    or waiting)."""
    if job.ranks == 1 and not job.disk_bytes and machine.threads == 1:
        # A process by itself traces and shades in turn.
        seconds = job.rays * (machine.visit_seconds + machine.shade_seconds)
        return seconds, seconds, "cores"
    return Simulation(machine, job).run()
