#!/usr/bin/env python3
"""A record of a larger run than any at hand, drawn from records of smaller ones, and what it predicts.

usage: larger_record.py PROGRAM TETRAHEDRA[,...] RANKS[,...] RECORD RECORD [RECORD ...] [--page FILE] [-- OPTION ...]

A record is the output folder of a run: report.json and tasks.csv. All records are runs of one case on one number of ranks, with
sizes ever smaller. Serial, repeated and other work, exchanges and memory of each stage are fitted over the records by
a + b n^q, n the number of tetrahedra, q out of 0, 1/3, 1/2, 2/3, 1, a and b not negative: the best in the sum of squares of
relative errors. Tasks are drawn, with replacement, from those of the largest record: their number and their mean cost go on by
the power of n between the two largest records. A piece of the mesh is drawn with all that is done to it. OPTIONs go to `scaling
--predict`. Printed are the fits of what is serial or repeated, and the predictions, geometry apart and included; all Markdown.
"""
import csv
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

from printed_table import PrintedTable, take_page_option

POWERS = (0, 1 / 3, 1 / 2, 2 / 3, 1)
SERIAL, REPEATED, DIVISIBLE, MEMORY = "serial", "repeated", "divisible", "own memory"
KINDS = ("broadcast", "all_gather", "table", "gather", "reduction", "neighbour", "rendezvous")
MOST_GROWTH = 1.0  # of the tasks' number, and of their number times their cost, as a power of n
MOST_FILES = 500   # parts of a written mesh (docs/formats.md)


class Record:
    def __init__(self, folder):
        report = json.loads((folder / "report.json").read_text())
        self.n, self.ranks, self.stages = report["mesh"]["tetrahedra"], report["ranks"], report["stages"]
        with open(folder / "tasks.csv") as file:
            self.tasks = [{**task, "number": int(task["number"]), "round": int(task["round"])} for task in csv.DictReader(file)]
        for task in self.tasks:
            for column in ("predicted", "cpu_seconds", "bytes", "child_bytes", "burden"):
                task[column] = float(task[column])

    def groups(self, stage):
        groups = {}
        for task in sorted(self.tasks, key=lambda t: t["number"]):
            if task["stage"] == stage:
                groups.setdefault((task["kind"], task["round"]), []).append(task)
        return groups

    def seconds(self, stage):
        """Serial, repeated and divisible CPU, as the replay reads them."""
        repeated = stage["repeated_seconds"]
        serial = max(0, stage["serial_seconds"] - repeated)
        of_tasks = sum(task["cpu_seconds"] for task in self.tasks if task["stage"] == stage["name"])
        divisible = max(0, stage["cpu_seconds_mean"] * self.ranks - serial - repeated * self.ranks - of_tasks)
        divisible += stage["check_seconds"] * self.ranks
        if stage["name"] == "start":
            repeated += stage["other_seconds"]
        else:
            divisible += stage["other_seconds"] * self.ranks
        return {SERIAL: serial, REPEATED: repeated, DIVISIBLE: divisible}


class Fit:
    """a + b n^q through values at n."""

    def __init__(self, ns, values):
        scale = max(values)
        self.a, self.b, self.q, self.error = 0.0, 0.0, 0, 0.0
        if scale <= 0:
            return
        best = math.inf
        for q in POWERS:
            for a, b in self.candidates(ns, values, q):
                errors = [(a + b * n**q - v) / max(v, 1e-3 * scale) for n, v in zip(ns, values)]
                if sum(e * e for e in errors) < best * (1 - 1e-9):
                    best = sum(e * e for e in errors)
                    self.a, self.b, self.q, self.error = a, b, q, max(map(abs, errors))

    @staticmethod
    def candidates(ns, values, q):
        """Least squares of relative errors with both, and with one of them 0."""
        w = [1 / max(v, 1e-3 * max(values)) for v in values]
        x, one, y = [wi * n**q for wi, n in zip(w, ns)], w, [wi * v for wi, v in zip(w, values)]
        dot = lambda u, v: sum(i * k for i, k in zip(u, v))
        if q > 0:
            yield 0.0, dot(x, y) / dot(x, x)
            d = dot(x, x) * dot(one, one) - dot(x, one) ** 2
            a = (dot(one, y) * dot(x, x) - dot(x, y) * dot(x, one)) / d
            b = (dot(x, y) * dot(one, one) - dot(one, y) * dot(x, one)) / d
            if a >= 0 and b >= 0:
                yield a, b
        yield dot(one, y) / dot(one, one), 0.0

    def at(self, n):
        return self.a + self.b * n**self.q

    def __str__(self):
        powers = {0: "", 1: " n", 1 / 2: " n^1/2", 1 / 3: " n^1/3", 2 / 3: " n^2/3"}
        return f"{self.a:.3g} + {self.b:.3g}{powers[self.q]}" if self.b else f"{self.a:.3g}"


def fitted(records, stage, figure):
    named = {r: next(s for s in r.stages if s["name"] == stage) for r in records}
    return Fit([r.n for r in records], [figure(r, named[r]) for r in records])


def power(before, after, n_before, n_after):
    return math.log(after / before) / math.log(n_after / n_before) if before > 0 and after > 0 else 0.0


def draw_tasks(records, stage, n, pieces, dice):
    """Rows of tasks.csv. `pieces` are places among the largest record's, in the order of the mesh's, or none yet."""
    last, before = records[-1], records[-2]
    rows = []
    earlier = before.groups(stage)
    for (kind, number_of_round), tasks in last.groups(stage).items():
        then = earlier.get((kind, number_of_round), [])
        mean = lambda of: sum(t["cpu_seconds"] for t in of) / len(of)
        more = min(MOST_GROWTH, max(0, power(len(then), len(tasks), before.n, last.n))) if then else 1.0
        heavier = min(MOST_GROWTH - more, max(0, power(mean(then), mean(tasks), before.n, last.n))) if then else 0.0
        factor = (n / last.n) ** heavier
        count = max(1, round(len(tasks) * (n / last.n) ** more))
        if kind == "file" and count > MOST_FILES:
            factor, count = factor * count / MOST_FILES, MOST_FILES
        if kind == "improved piece" and len(tasks) == pieces["of record"]:
            drawn = pieces["drawn"]
        else:
            drawn = list(range(len(tasks))) if count == len(tasks) else [dice.randrange(len(tasks)) for i in range(count)]
        if kind == "core piece":
            drawn.sort()  # neighbours along the curve are alike
        if kind in ("zone", "core piece") and number_of_round == min(r for k, r in last.groups(stage) if k == kind):
            pieces["drawn"] = pieces["drawn"] + [pieces["of record"] + i for i in drawn]
            pieces["of record"] += len(tasks)
        for number, i in enumerate(drawn):
            row = dict(tasks[i], number=number, rank=0)
            for column in ("predicted", "cpu_seconds", "bytes", "burden"):
                row[column] *= factor
            rows.append(row)
    return rows


def larger(records, n, folder):
    """Writes the record into the folder; returns the fits of what is serial or repeated."""
    dice, fits, stages, rows = random.Random(1), [], [], []
    pieces = {"drawn": [], "of record": 0}
    ranks = records[-1].ranks
    for stage in records[-1].stages:
        name = stage["name"]
        tasks = draw_tasks(records, name, n, pieces, dice)
        rows += tasks
        of = {what: fitted(records, name, lambda r, s, what=what: r.seconds(s)[what]) for what in (SERIAL, REPEATED, DIVISIBLE)}
        fits += [(name, what, of[what]) for what in (SERIAL, REPEATED)]
        seconds = {what: fit.at(n) for what, fit in of.items()}
        all_seconds = seconds[SERIAL] + seconds[REPEATED] * ranks + seconds[DIVISIBLE] + sum(t["cpu_seconds"] for t in tasks)
        exchange = lambda kind, what: round(fitted(records, name, lambda r, s: s["exchanges"][kind][what]).at(n))
        message = lambda kind, what: round(fitted(records, name, lambda r, s: s["messages"][kind][what]).at(n))
        stages.append({
            "name": name, "serial_seconds": seconds[SERIAL] + seconds[REPEATED], "repeated_seconds": seconds[REPEATED],
            "cpu_seconds_mean": all_seconds / ranks, "check_seconds": 0, "other_seconds": 0,
            "peak_own_bytes_max": fitted(records, name, lambda r, s: s["peak_own_bytes_max"]).at(n),
            "exchanges": {kind: {what: exchange(kind, what) for what in ("count", "bytes")} for kind in KINDS},
            "messages": {kind: {what: message(kind, what) for what in ("count", "count_max", "bytes")}
                         for kind in ("collective", "neighbour", "rendezvous")}})
    (folder / "report.json").write_text(json.dumps({"status": "ok", "ranks": ranks, "stages": stages, "mesh": {"tetrahedra": n}}))
    columns = ["rank", "stage", "kind", "number", "predicted", "cpu_seconds", "bytes", "child_bytes", "round", "burden"]
    with open(folder / "tasks.csv", "w") as file:
        file.write(",".join(columns) + "\n")
        for row in rows:
            file.write(",".join(str(row[column]) for column in columns) + "\n")
    return fits


def tabulate_fits(records, fits, page):
    table = PrintedTable("Fits", ("stage", "seconds", *(f"{r.n:.3g}" for r in records), "fit", "largest error"))
    for name, what, fit in fits:
        values = [r.seconds(next(s for s in r.stages if s["name"] == name))[what] for r in records]
        if max(values) >= 0.01:
            table.add(name, what, *(f"{v:.3f}" for v in values), fit, f"{100 * fit.error:.0f} %")
    table.save(page)
    print()


def add_predictions(table, program, folder, n, many, options):
    subprocess.run([program, "scaling", "--predict", str(folder), "--ranks", many, *options], check=True, capture_output=True)
    for row in json.loads((folder / "prediction.json").read_text())["rows"]:
        geometry = next(stage for stage in row["stages"] if stage["name"] == "geometry")
        apart = row["seconds"] - geometry["seconds"]
        alone = row["seconds"] * row["efficiency"] * row["ranks"]  # of one rank
        of_geometry = geometry["seconds"] - geometry["losses"]["communication"]
        losses = {key: value - geometry["losses"][key] for key, value in row["losses"].items()}
        worst = sorted(losses.items(), key=lambda item: -item[1])[:3]
        table.add(f"{n:.3g}", row["ranks"], f"{row['seconds']:.1f}", f"{100 * row['efficiency']:.0f} %",
                  f"{100 * (alone - of_geometry) / apart / row['ranks']:.0f} %",
                  ", ".join(f"{key} {value:.2f}" for key, value in worst))


def main():
    arguments = sys.argv[1:]
    options = arguments[arguments.index("--") + 1:] if "--" in arguments else []
    arguments = arguments[:arguments.index("--")] if "--" in arguments else arguments
    arguments, page = take_page_option(arguments)
    if len(arguments) < 5:
        sys.exit(__doc__)
    program, sizes, many = arguments[:3]
    records = sorted((Record(pathlib.Path(folder)) for folder in arguments[3:]), key=lambda r: r.n)
    table = None
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for size in sizes.split(","):
            fits = larger(records, float(size), folder)
            if table is None:
                tabulate_fits(records, fits, page)
                table = PrintedTable("Predictions", ("tetrahedra", "ranks", "seconds", "efficiency", "geometry apart",
                                                     "largest losses, geometry apart, s"))
            add_predictions(table, program, folder, float(size), many, options)
    table.save(page)


if __name__ == "__main__":
    main()
