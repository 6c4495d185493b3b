"""Slurm on this machine alone, for tests/batch.py and tests/benchmark/batch_table: one node, its controller and its
authentication, all of it in a folder. Takes root, and the programs that `missing` looks for.
"""
import os
import re
import shutil
import socket
import subprocess
import time

from expectations import expect

SLURM = """ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
AuthInfo=socket={folder}/munge.socket
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
JobAcctGatherType=jobacct_gather/linux
JobAcctGatherFrequency=task=1
JobAcctGatherParams=OverMemoryKill
SlurmdParameters=config_overrides
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=4000 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


class Slurm:
    """One node, its controller and its authentication; all of it in a folder."""

    def __init__(self, folder):
        self.folder = folder
        with socket.socket() as one, socket.socket() as other:
            one.bind(("127.0.0.1", 0))
            other.bind(("127.0.0.1", 0))
            ports = one.getsockname()[1], other.getsockname()[1]
        for name in ("state", "spool"):
            os.mkdir(f"{folder}/{name}")
        with open(f"{folder}/slurm.conf", "w", encoding="ascii") as conf:
            conf.write(SLURM.format(host=socket.gethostname().split(".")[0], folder=folder, ports=ports))
        with open(os.open(f"{folder}/munge.key", os.O_WRONLY | os.O_CREAT, 0o600), "wb") as key:
            key.write(os.urandom(128))
        os.environ["SLURM_CONF"] = f"{folder}/slurm.conf"

    def __enter__(self):
        folder = self.folder
        self.daemons = [
            subprocess.Popen(["munged", "--foreground", "--force", f"--key-file={folder}/munge.key", f"--socket={folder}/munge.socket",
                              f"--pid-file={folder}/munged.pid", f"--log-file={folder}/munged.log", f"--seed-file={folder}/munge.seed"],
                             stderr=subprocess.DEVNULL),
            subprocess.Popen(["slurmctld", "-D"], stderr=subprocess.DEVNULL),
            subprocess.Popen(["slurmd", "-D"], stderr=subprocess.DEVNULL)]
        for _ in range(60):
            told = subprocess.run(["sinfo", "--noheader", "--format=%T"], capture_output=True, text=True, check=False).stdout
            if told.strip() == "idle":
                return self
            time.sleep(0.5)
        expect(False, f"Slurm starts: {told}")
        return self

    def __exit__(self, *_):
        for daemon in reversed(self.daemons):
            daemon.terminate()
            daemon.wait()

    def jobs(self):
        """(state, megabytes, processors) of each, in order."""
        told = subprocess.run(["scontrol", "--oneliner", "show", "job"], capture_output=True, text=True, check=False).stdout
        return [(state, int(memory), int(processors)) for processors, state, memory in
                ((re.search(r"NumCPUs=(\d+)", line)[1], re.search(r"JobState=(\w+)", line)[1],
                  re.search(r"MinMemoryNode=(\d+)M", line)[1]) for line in told.splitlines() if "JobId" in line)]


def missing():
    """What must be there and isn't."""
    tools = [tool for tool in ("munged", "slurmctld", "slurmd", "sbatch") if not shutil.which(tool)]
    return tools or ["root"] * (os.geteuid() != 0)
