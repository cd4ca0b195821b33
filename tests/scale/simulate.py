#!/usr/bin/env python3
"""Simulates sweeps on 10 to 10,000 cores from the measured costs in results/benchmarks/scale.md.

Shards of one core each are drawn with costs as in harness/shards: sequences stay together, longest first. The true
duration of a cell is its estimate times a lognormal factor. One merge follows, on one machine. Prints Markdown.
"""
import argparse
import heapq
import random


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--start", type=float, default=0.5, help="start of a shard, with its job [s]")
    parser.add_argument("--plan", type=float, default=2e-6, help="reading the config, per cell of the sweep [s]")
    parser.add_argument("--load", type=float, default=0.02, help="loading a sequence [s]")
    parser.add_argument("--merge", type=float, default=1e-4, help="merging one cell [s]")
    parser.add_argument("--methods", type=int, default=40, help="cells of one sequence and repeat")
    parser.add_argument("--dispersion", type=float, default=0.3, help="of the logarithms of cell durations [-]")
    parser.add_argument("--seed", type=int, default=1)
    return parser.parse_args()


def largest_shard(sequences, shards, cell, a, draw):
    """Duration of the last shard: sequences of equal estimates in turn, split below one per shard."""
    pieces = [a.methods] * sequences
    if sequences < 4 * shards:
        parts = min(a.methods, -(-4 * shards // sequences))
        pieces = [a.methods / parts] * (sequences * parts)
    loads = [0.0] * shards
    heapq.heapify(loads)
    actual = [0.0] * shards
    order = [(0.0, i) for i in range(shards)]
    heapq.heapify(order)
    for cells in pieces:
        load, i = heapq.heappop(order)
        heapq.heappush(order, (load + a.load + cells * cell, i))
        spread = a.dispersion / max(1.0, cells) ** 0.5
        actual[i] += a.load + cells * cell * draw.lognormvariate(-0.5 * spread * spread, spread)
    return max(actual)


def main():
    a = arguments()
    draw = random.Random(a.seed)
    print("| cells | cell [s] | cores | compute [s] | merge [s] | efficiency | with parallel merge |")
    print("| ----: | -------: | ----: | ----------: | --------: | ---------: | ------------------: |")
    for cells, cell in ((100_000, 0.002), (1_000_000, 0.002), (1_000_000, 0.05), (1_000_000, 1.0)):
        for cores in (10, 100, 1_000, 10_000):
            sequences = cells // a.methods
            compute = a.start + a.plan * cells + largest_shard(sequences, cores, cell, a, draw)
            merge = a.merge * cells
            work = cells * cell + sequences * a.load
            # One merged partition per 100 shards, read together; the last step copies nothing.
            partitions = max(1, cores // 100)
            efficiency = work / cores / (compute + merge)
            parallel = work / cores / (compute + merge / partitions)
            print(f"| {cells} | {cell:g} | {cores} | {compute:.4g} | {merge:.4g} | {100 * efficiency:.1f} % | "
                  f"{100 * parallel:.1f} % |")


main()
