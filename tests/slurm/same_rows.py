#!/usr/bin/env python3
"""Compares the rows of two stores: same_rows.py LOOPBENCH STORE STORE.

All columns of `loopbench export` but times, as text, so every bit of a number counts; the order does not. Prints the
number of rows, or the first differences and exits with 1.
"""
import collections
import csv
import subprocess
import sys

MOST_PRINTED = 3
TIMES = "milliseconds"  # and the metric `time`


def rows(loopbench, store):
    """Numbers of occurrences of the rows."""
    process = subprocess.Popen([loopbench, "export", store], stdout=subprocess.PIPE, text=True)
    reader = csv.reader(process.stdout)
    header = next(reader, [])
    time, metric = header.index(TIMES), header.index("metric")
    out = collections.Counter("|".join(row[:time] + row[time + 1:]) for row in reader if row[metric] != "time")
    if process.wait() != 0:
        sys.exit(f"{store}: cannot be exported")
    return out


def main():
    loopbench, first, second = sys.argv[1:4]
    expected, found = rows(loopbench, first), rows(loopbench, second)
    if expected != found:
        for store, others in ((first, expected - found), (second, found - expected)):
            print(f"{store}: {others.total()} rows that the other store lacks")
            print(*(f"  {row}" for row in list(others)[:MOST_PRINTED]), sep="\n")
        sys.exit(1)
    print(f"{expected.total()} equal rows")


main()
