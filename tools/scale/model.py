# SPDX-License-Identifier: Apache-2.0
"""A model of ranks that share a scene out: a discrete-event simulation of a picture's rays.

Each rank has a home, which sends rays off and takes their answers, a server, which traces what
visits it in batches, and a transport. Home and server want cores of the rank's node, the transport
its network. A call's rays go to their first stop in messages; of those that come back a part goes
on to another. What is simulated follows docs/decisions/0031; rates are measured (scale.py).
"""
import dataclasses
import heapq
import itertools
import math

MESSAGE = 1 << 15       # visits a message at most: messages that follow each other count as one
BATCH = 1 << 17        # visits a batch of the server at most, as in plugin/ranks/visit_server.cpp
VISIT_BYTES, ANSWER_BYTES = 72, 32
MAX_SIMULATED = 16     # ranks; of more, so many stand for all


@dataclasses.dataclass
class Machine:
    """What a rank runs on. Seconds are of one core, unless a device is said to trace."""
    cores: int = 2                 # of a node
    ranks_per_node: int = 1
    visit_seconds: float = 1e-6    # of the server, a visit, on `server_cores` cores
    server_cores: int = 1
    batch_seconds: float = 1e-3    # of the server, a batch, besides its visits
    home_seconds: float = 1e-7     # of the home, a visit: to send it off and take its answer
    shade_seconds: float = 1e-7    # of the home, a ray, between calls
    message_seconds: float = 2e-6  # of latency, a message
    message_cpu: float = 1e-6      # of the home, a message
    bandwidth: float = 1e10        # bytes a second, of a node each way; no limit within a node
    disk: float = 2e9              # bytes a second, of a node


@dataclasses.dataclass
class Job:
    """A picture. rays: of each call one after the other, over all ranks."""
    ranks: int
    rays: list
    visits_per_ray: float
    imbalance: float = 1.0         # the busiest share's visits to the mean
    disk_bytes: float = 0          # that are read, over all ranks


class Resource:
    """So many servants; what is asked for begins when one is free, first come, first served."""

    def __init__(self, count):
        self.free = [0.0] * count
        self.busy = 0.0

    def take(self, now, seconds, servants=1):
        begin = now
        for _ in range(min(servants, len(self.free))):
            begin = max(begin, heapq.heappop(self.free))
        for _ in range(min(servants, len(self.free))):
            heapq.heappush(self.free, begin + seconds)
        self.busy += seconds * servants
        return begin + seconds


class Simulation:
    def __init__(self, machine, job):
        self.machine, self.job = machine, job
        self.shown = min(job.ranks, MAX_SIMULATED)
        self.events, self.order, self.now = [], itertools.count(), 0.0
        nodes = math.ceil(self.shown / machine.ranks_per_node)
        self.cores = [Resource(machine.cores) for _ in range(nodes)]
        self.network = [Resource(1) for _ in range(nodes)]
        self.disks = [Resource(1) for _ in range(nodes)]
        self.waiting = [[] for _ in range(self.shown)]
        self.serving = [False] * self.shown
        self.call = [-1] * self.shown
        self.away = [0] * self.shown  # messages of a home that are on their way or elsewhere
        self.ends = [0.0] * self.shown
        self.unread = job.disk_bytes / job.ranks
        mean = (job.ranks - job.imbalance) / max(job.ranks - 1, 1)
        self.weights = [(job.imbalance if rank == 0 else mean) / self.shown
                        for rank in range(self.shown)]
        scale = 1 / sum(self.weights)
        self.weights = [weight * scale for weight in self.weights]

    def node(self, rank):
        return rank // self.machine.ranks_per_node

    def at(self, time, what, *arguments):
        heapq.heappush(self.events, (time, next(self.order), what, arguments))

    def run(self):
        """Returns the seconds of the picture and what limits it."""
        for rank in range(self.shown):
            self.at(0.0, self.next_call, rank)
        while self.events:
            self.now, _, what, arguments = heapq.heappop(self.events)
            what(*arguments)
        seconds = max(self.ends)
        used = {"cores": max(r.busy / len(r.free) for r in self.cores),
                "network": max(r.busy for r in self.network),
                "disk": max(r.busy for r in self.disks)}
        limit = max(used, key=used.get)
        return seconds, limit if used[limit] > 0.5 * seconds else "waiting"

    def next_call(self, rank):
        self.call[rank] += 1
        if self.call[rank] == len(self.job.rays):
            self.ends[rank] = self.now
            return
        rays = self.job.rays[self.call[rank]] / self.job.ranks
        done = self.cores[self.node(rank)].take(self.now, rays * self.machine.shade_seconds)
        if rays < 1e-9:
            self.at(done, self.next_call, rank)
        else:
            self.at(done, self.send_off, rank, rays, None)

    def send_off(self, home, visits, but):
        """Sends visits of a home's rays to all ranks but one, by the weights of their shares."""
        total = sum(w for rank, w in enumerate(self.weights) if rank != but)
        for rank in range(self.shown):
            if rank == but:
                continue
            rest = visits * self.weights[rank] / total
            while rest > 1e-9:
                count = min(rest, MESSAGE)
                rest -= count
                self.away[home] += 1
                self.send(home, rank, count, VISIT_BYTES, self.arrive)

    def send(self, home, other, count, size, then):
        """A message between a home and another rank; then(other, home, count) when it is there."""
        machine, job = self.machine, self.job
        sender = home if then == self.arrive else other
        # One simulated rank stands for several, each of which gets a message of its own.
        messages = max(1.0, min(count, job.ranks / self.shown))
        cpu = count * machine.home_seconds / 2 + messages * machine.message_cpu
        sent = self.cores[self.node(sender)].take(self.now, cpu)
        if self.node(home) != self.node(other):
            sent = self.network[self.node(sender)].take(sent, count * size / machine.bandwidth)
            sent += machine.message_seconds
        self.at(sent, then, other, home, count)

    def arrive(self, rank, home, count):
        self.waiting[rank].append((home, count))
        self.serve(rank)

    def serve(self, rank):
        if self.serving[rank] or not self.waiting[rank]:
            return
        self.serving[rank] = True
        batch, visits = [], 0.0
        while self.waiting[rank] and visits < BATCH:
            batch.append(self.waiting[rank].pop(0))
            visits += batch[-1][1]
        machine = self.machine
        begun = self.now
        if self.unread > 0:  # pages of the share come from the disk once
            part = min(self.unread, self.job.disk_bytes / self.job.ranks / 8)
            self.unread -= part / self.shown
            begun = self.disks[self.node(rank)].take(self.now, part / machine.disk)
        seconds = machine.batch_seconds + visits * machine.visit_seconds
        done = self.cores[self.node(rank)].take(begun, seconds, machine.server_cores)
        self.at(done, self.served, rank, batch)

    def served(self, rank, batch):
        self.serving[rank] = False
        for home, count in batch:
            self.send(home, rank, count, ANSWER_BYTES, self.come_home)
        self.serve(rank)

    def come_home(self, rank, home, count):
        further = count * (1 - 1 / self.job.visits_per_ray)
        if self.shown == 1 or further < 0.5:
            further = 0
        self.away[home] -= 1
        if further:
            self.send_off(home, further, rank)
        elif self.away[home] == 0:
            self.next_call(home)


def simulate(machine, job):
    """Returns (seconds of the picture, what limits it: cores, network, disk or waiting)."""
    return Simulation(machine, job).run()
