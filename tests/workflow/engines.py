"""What runs of workflows share: folders compared, and a Slurm of one node."""
import json
import os
import shutil
import subprocess
import time

TIMES = {"timings", "seconds", "export_seconds", "peak_memory_bytes", "rays_per_second"}


def without_times(value):
    if isinstance(value, dict):
        return {k: without_times(v) for k, v in value.items() if k not in TIMES}
    return [without_times(v) for v in value] if isinstance(value, list) else value


def differences(one, other):
    """What two output folders do not share."""
    files = {p.relative_to(f) for f in (one, other) for p in f.rglob("*") if p.is_file()}
    bad = []
    for path in sorted(files):
        a, b = one / path, other / path
        if not a.exists() or not b.exists():
            bad.append(f"{path} is in one of them")
        elif path.name == "report.json":
            if without_times(json.loads(a.read_text())) != without_times(json.loads(b.read_text())):
                bad.append("report.json differs by more than times")
        elif path.name != "report.html" and a.read_bytes() != b.read_bytes():
            bad.append(f"{path} differs")
    return bad


class Slurm:
    """One node on the loopback address, with all its files in a folder of its own."""

    def __init__(self, folder, processors=os.cpu_count()):
        self.folder, self.processors = folder, processors

    def __enter__(self):
        for name in ("state", "spool"):
            (self.folder / name).mkdir(parents=True)
        host = subprocess.run(["hostname", "-s"], stdout=subprocess.PIPE, text=True, check=True).stdout.strip()
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o600)
        f = self.folder
        (f / "slurm.conf").write_text(f"""ClusterName=test
SlurmctldHost={host}(127.0.0.1)
AuthType=auth/munge
AuthInfo=socket={f}/munge.socket
SlurmUser=root
SlurmdUser=root
StateSaveLocation={f}/state
SlurmdSpoolDir={f}/spool
SlurmctldPidFile={f}/slurmctld.pid
SlurmdPidFile={f}/slurmd.pid
SlurmctldLogFile={f}/slurmctld.log
SlurmdLogFile={f}/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/builtin
ReturnToService=2
SlurmctldPort=16827
SlurmdPort=16828
MpiDefault=none
NodeName={host} NodeAddr=127.0.0.1 CPUs={self.processors} RealMemory=4000 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
""")
        self.environment = dict(os.environ, SLURM_CONF=str(f / "slurm.conf"))
        files = {"key-file": key, "socket": f / "munge.socket", "pid-file": f / "munged.pid", "log-file": f / "munged.log", "seed-file": f / "munged.seed"}
        self.started = []
        self.start(["munged", "--foreground", "--force", *(f"--{k}={v}" for k, v in files.items())])
        time.sleep(1)
        self.start(["slurmctld", "-D"])
        self.start(["slurmd", "-D"])
        for _ in range(60):
            if "idle" in subprocess.run(["sinfo", "-h", "-o", "%t"], env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout:
                return self.environment
            time.sleep(0.5)
        self.__exit__()
        raise OSError("Slurm's node does not come up")

    def start(self, command):
        self.started.append(subprocess.Popen(command, env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))

    def __exit__(self, *_):
        for child in reversed(self.started):
            child.terminate()
        for child in self.started:
            try:
                child.wait(10)
            except subprocess.TimeoutExpired:
                child.kill()


def has(*programs):
    return all(shutil.which(p) for p in programs)
