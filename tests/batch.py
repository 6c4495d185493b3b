"""Runs examples/batch by Snakemake on five scans, three of which are no parts, and interrupts and kills it on the way.

usage: batch.py --batch FOLDER --command SCAN2FEA --scan SCAN.ply --scans FOLDER_OF_SCANS local|slurm
slurm: on a node of Slurm that is started here, on this machine alone. Prints what is wrong; exit status 1 if anything is,
77 where Snakemake or Slurm is missing.
"""
import argparse
import collections
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import one_node_slurm
from expectations import expect, wrong

CODES = {"bracket.ply": 0, "fandisk.off": 0, "broken.stl": 3, "it's <not> a scan.txt": 3, "lion.off": 4}

# The command, which notes what it is called for, and kills its job when it first comes to one of the scans.
WRAPPER = """#!/bin/bash
if [[ $1 == run ]]; then
  basename "$2" >> '{folder}/calls'
  if [[ $2 == *fandisk* ]] && mkdir '{folder}/killed' 2>/dev/null; then kill -9 $PPID $$; fi
fi
exec '{command}' "$@"
"""


class Batch:
    def __init__(self, asked, folder):
        self.folder = folder
        self.profile = "slurm" if asked.where == "slurm" else "local"
        os.mkdir(f"{folder}/scans")
        self.scan = asked.scan
        shutil.copy(asked.scan, f"{folder}/scans/bracket.ply")
        for name in ("fandisk.off", "lion.off"):
            shutil.copy(f"{asked.scans}/{name}", f"{folder}/scans")
        for name, text in (("broken.stl", "solid x\nfacet normal 0 0\n"), ("it's <not> a scan.txt", "hello\n")):
            with open(f"{folder}/scans/{name}", "w", encoding="ascii") as file:
                file.write(text)
        with open(f"{folder}/scan2fea", "w", encoding="ascii") as wrapper:
            wrapper.write(WRAPPER.format(folder=folder, command=os.path.abspath(asked.command)))
        os.chmod(f"{folder}/scan2fea", 0o755)
        self.line = ["snakemake", "--snakefile", f"{asked.batch}/Snakefile", "--profile", f"{asked.batch}/{self.profile}"]

    def start(self, *config):
        if os.path.exists(f"{self.folder}/calls"):
            os.remove(f"{self.folder}/calls")
        return subprocess.Popen([*self.line, "--config", f"command={self.folder}/scan2fea", *config], cwd=self.folder,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def run(self, *config, status=0):
        running = self.start(*config)
        told, _ = running.communicate()
        expect(running.returncode == status, f"snakemake ends with {running.returncode}, not {status}:\n{told[-3000:]}")

    def calls(self):
        if not os.path.exists(f"{self.folder}/calls"):
            return {}
        with open(f"{self.folder}/calls", encoding="ascii") as calls:
            return dict(collections.Counter(calls.read().splitlines()))

    def verdict(self, scan):
        try:
            with open(f"{self.folder}/results/{scan}/verdict.json", encoding="utf-8") as file:
                return json.load(file)
        except FileNotFoundError:
            return None

    def page(self, folder="results"):
        with open(f"{self.folder}/{folder}/summary.html", encoding="utf-8") as file:
            return file.read()


def mesh_all(batch):
    batch.run()
    expect(batch.calls() == {scan: 1 + (scan == "fandisk.off") for scan in CODES},
           f"the job that was killed is tried again, and no other: {batch.calls()}")
    for scan, code in CODES.items():
        verdict = batch.verdict(scan)
        expect(verdict and verdict["exit_code"] == code, f"of {scan}: {verdict}")
        expect(os.path.exists(f"{batch.folder}/results/{scan}/part.inp") == (code == 0), f"{scan} is meshed, or is not")
        expect(code == 0 or len(verdict["reasons"]) == 1, f"why not is told: {verdict}")
    page = batch.page()
    expect("2 of 5 scans are meshed" in page and "it&#x27;s &lt;not&gt; a scan.txt" in page, "one page tells of all")
    expect("hole is too large" in page and "before endsolid" in page, "with the reasons")
    batch.run()
    expect(batch.calls() == {}, f"what is done is not done again, failures included: {batch.calls()}")
    os.remove(f"{batch.folder}/results/bracket.ply/verdict.json")
    batch.run()
    expect(batch.calls() == {"bracket.ply": 1}, f"what is missing is done, and nothing else: {batch.calls()}")


# As a copy that keeps its time.
def replace_by_an_older_scan(batch):
    scan = f"{batch.folder}/scans/bracket.ply"
    before = batch.verdict("bracket.ply")
    shutil.copy(f"{batch.folder}/scans/broken.stl", scan)
    os.utime(scan, (0, 0))
    batch.run()
    expect(batch.calls() == {"bracket.ply": 1}, f"an older scan in its place is another one: {batch.calls()}")
    expect(batch.verdict("bracket.ply") != before and "1 of 5 scans are meshed" in batch.page(), "and so is the result")
    shutil.copy(batch.scan, scan)
    batch.run()
    expect(batch.verdict("bracket.ply")["exit_code"] == 0, "until the first is back")


def refuse_braces(batch):
    scan = f"{batch.folder}/scans/{{odd}}.ply"
    shutil.copy(batch.scan, scan)
    running = batch.start()
    told, _ = running.communicate()
    expect(running.returncode == 1 and "{odd}.ply: Snakemake takes braces" in told, f"braces are told: {told[-3000:]}")
    os.remove(scan)


def interrupt(batch):
    shutil.rmtree(f"{batch.folder}/results")
    running = batch.start()
    while sum(batch.verdict(scan) is not None for scan in CODES) < 2 and running.poll() is None:
        time.sleep(0.05)
    running.send_signal(signal.SIGINT)
    running.communicate()
    batch.run()
    expect(0 < len(batch.calls()) < 5, f"after an interrupt the rest is done, and not all: {batch.calls()}")
    expect(all(batch.verdict(scan)["exit_code"] == code for scan, code in CODES.items()), "with the same results")


# Memory by the scan's size; what is killed for want of it gets three times as much, once.
def run_short_of_memory(batch, slurm):
    expect(all(processors == 1 for _, _, processors in slurm.jobs()), "jobs have one processor each")
    expect(len({memory for _, memory, _ in slurm.jobs()}) > 1, f"and memory by the scan's size: {slurm.jobs()}")
    before = len(slurm.jobs())
    os.mkdir(f"{batch.folder}/one")
    shutil.copy(f"{batch.folder}/scans/bracket.ply", f"{batch.folder}/one")
    batch.run("scans=one", "results=little", "base_mb=10", "mb_per_mb=0", status=1)
    states = [(state, memory) for state, memory, _ in slurm.jobs()[before:]]
    expect([memory for _, memory in states] == [10, 30], f"the second attempt has three times the memory: {states}")
    expect(all(state != "COMPLETED" for state, _ in states), f"and neither is enough: {states}")
    expect("0 of 1 scans" in batch.page("little") and "killed" in batch.page("little"), "the page tells of the rest")


def main():
    parser = argparse.ArgumentParser()
    for name in ("batch", "command", "scan", "scans"):
        parser.add_argument("--" + name, required=True)
    parser.add_argument("where", choices=("local", "slurm"))
    asked = parser.parse_args()
    asked.batch = os.path.abspath(asked.batch)
    missing = [tool for tool in ["snakemake"] if not shutil.which(tool)]
    missing += one_node_slurm.missing() if asked.where == "slurm" else []
    if missing:
        print(f"skipped: {', '.join(missing)} is missing")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        os.mkdir(f"{folder}/work")
        batch = Batch(asked, f"{folder}/work")
        if asked.where == "local":
            mesh_all(batch)
            replace_by_an_older_scan(batch)
            refuse_braces(batch)
            interrupt(batch)
        else:
            with one_node_slurm.Slurm(folder) as slurm:
                mesh_all(batch)
                run_short_of_memory(batch, slurm)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
