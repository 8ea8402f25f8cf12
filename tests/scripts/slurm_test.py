#!/usr/bin/env python3
"""`experiment plan --slurm` under Slurm itself: two nodes on this machine, one of which dies in the middle.

    slurm_test.py AIRLIGHT [EXPERIMENT...]

Needs Debian's slurm-wlm and munge, and root to start them; skipped elsewhere. Without EXPERIMENT it runs one of its own. The errors of all
tables must equal those of one run, bit for bit.
"""
import contextlib
import csv
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
CONF = """ClusterName=local
SlurmctldHost={host}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
CredType=cred/munge
SlurmctldPort={port}
StateSaveLocation={folder}/ctld
SlurmdSpoolDir={folder}/%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/%n.pid
SlurmctldLogFile={folder}/ctld.log
SlurmdLogFile={folder}/%n.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MpiDefault=none
ReturnToService=2
SlurmdParameters=config_overrides
MinJobAge=86400
NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 Port={port_1} CPUs=1 RealMemory=4000 State=UNKNOWN
NodeName=n2 NodeHostname={host} NodeAddr=127.0.0.1 Port={port_2} CPUs=1 RealMemory=4000 State=UNKNOWN
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
"""
SCENE = """[film]
width = 48
height = 36
[camera]
position = [0, 0, 4]
look_at = [0, 0, 0]
[[light]]
type = "point"
position = [1.5, 2, 1]
intensity = 5
[[medium]]
type = "homogeneous"
sigma_t = 0.5
region = { type = "box", lo = [-1, -1, -1], hi = [1, 1, 1] }
"""
EXPERIMENT = """title = "Steps"
layer = "mean"
metrics = ["rel_l2", "bias"]
[profile.quick]
budget = 0
[reference]
renderer = "path_tracer"
settings = { samples = 256, max_order = 1 }
[[scene]]
file = "scenes/one.toml"
"""


def skip(why):
    print(f"test skipped: {why}")
    sys.exit(0)


def quiet(*command, **options):
    return subprocess.run(command, capture_output=True, text=True, **options)


def until(condition, what, seconds=90):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"{what}: not within {seconds} s")
        time.sleep(0.2)


def free_ports(count):
    with contextlib.ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(count)]
        for s in sockets:
            s.bind(("127.0.0.1", 0))
        return [s.getsockname()[1] for s in sockets]


@contextlib.contextmanager
def slurm(folder):
    """Slurm with the nodes n1 and n2, for the programs that this starts."""
    started = []
    if quiet("munge", "-n").returncode != 0:
        os.makedirs("/run/munge", exist_ok=True)
        shutil.chown("/run/munge", "munge", "munge")
        started.append(subprocess.Popen(["runuser", "-u", "munge", "--", "/usr/sbin/munged", "--foreground"], stderr=subprocess.DEVNULL))
        until(lambda: quiet("munge", "-n").returncode == 0, "munge answers")
    for name in ("ctld", "n1", "n2"):
        os.mkdir(f"{folder}/{name}")
    ports = free_ports(3)
    os.environ["SLURM_CONF"] = f"{folder}/slurm.conf"
    with open(os.environ["SLURM_CONF"], "w", encoding="utf-8") as out:
        out.write(CONF.format(host=socket.gethostname().split(".")[0], folder=folder, port=ports[0], port_1=ports[1], port_2=ports[2]))
    try:
        started.append(subprocess.Popen(["slurmctld", "-D"], stderr=subprocess.DEVNULL))
        for node in ("n1", "n2"):
            started.append(subprocess.Popen(["slurmd", "-D", "-N", node], stderr=subprocess.DEVNULL))
        until(lambda: quiet("sinfo", "-h", "-N", "-t", "idle").stdout.count("\n") == 2, "both nodes are idle")
        yield started[-1]
    finally:
        quiet("scancel", "--state=PENDING")
        quiet("scancel", "--state=RUNNING")
        for process in reversed(started):
            process.terminate()
        for process in started:
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()


def errors(folder, name):
    """Cells of table.csv that are errors, as texts."""
    with open(f"{folder}/{name}/table.csv", encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    names = [n for n in rows[0] if "second" not in n and "time" not in n and n not in ("device", "front", "runs")]
    return [[row[n] for n in names] for row in rows]


def kill_node(slurmd):
    """As if the node lost its power: the daemon and all that runs on it end at once."""
    victims = [pid for pid in os.listdir("/proc") if pid.isdigit() and b"SLURMD_NODENAME=n2\0" in environment_of(pid)]
    slurmd.kill()
    for pid in victims:
        with contextlib.suppress(ProcessLookupError):
            os.kill(int(pid), signal.SIGKILL)
    quiet("scontrol", "update", "nodename=n2", "state=down", "reason=killed")
    return len(victims)


def all_ended():
    """A job that is queued again waits for two minutes by default: not here."""
    jobs = [line.split() for line in quiet("squeue", "-h", "-r", "-o", "%A %r").stdout.splitlines()]
    for job, reason in jobs:
        if reason == "BeginTime":
            quiet("scontrol", "update", f"jobid={job}", "starttime=now")
        if reason == "DependencyNeverSatisfied":
            raise AssertionError("a stage failed")
    return not jobs


def environment_of(pid):
    try:
        with open(f"/proc/{pid}/environ", "rb") as stream:
            return stream.read()
    except OSError:
        return b""


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    airlight, names = os.path.abspath(sys.argv[1]), sys.argv[2:]
    if any(shutil.which(program) is None for program in ("slurmctld", "slurmd", "sbatch", "munge")):
        skip("there is no Slurm (slurm-wlm, munge)")
    if os.geteuid() != 0:
        skip("only root can start Slurm's daemons")
    with tempfile.TemporaryDirectory() as folder:
        project = ROOT
        if not names:
            names, project = ["g/e"], f"{folder}/project"
            os.makedirs(f"{project}/experiments/scenes")
            os.makedirs(f"{project}/experiments/g")
            methods = "".join(f'[[method]]\nname = "march {n}"\nrenderer = "ray_marcher"\nsettings = {{ steps = {n} }}\n'
                              for n in (2, 4, 8, 4000, 8000, 12000, 16000, 20000))
            for name, text in (("README.md", ""), ("scenes/one.toml", SCENE), ("g/e.toml", EXPERIMENT + methods)):
                with open(f"{project}/experiments/{name}", "w", encoding="utf-8") as out:
                    out.write(text)
        # The run has a cache of its own: its references are rendered in one go, those of the plan in ranges of samples.
        whole = f"{project}/results" if project != ROOT else f"{folder}/whole"
        quiet(airlight, "experiment", "run", *names, "--root", project, "--cache", f"{folder}/own", "--results", whole, "--threads", "2")
        cache = ["--root", project, "--cache", f"{folder}/cache"]
        plan = quiet(airlight, "experiment", "plan", *names, *cache, "--tasks", "4", "--least", "0.01", "--without-times", "--slurm",
                     "--memory", "1", "--work", f"{folder}/plan", check=True)
        assert project == ROOT or plan.stdout.count("--samples") == 4, plan.stdout
        with slurm(folder) as second_node:
            begin = time.monotonic()
            quiet("sh", "-c", plan.stdout, check=True)
            running = lambda: "rows" in quiet("squeue", "-h", "-t", "R", "-w", "n2", "-o", "%j").stdout  # noqa: E731
            until(running, "rows are computed on both nodes", 60)
            time.sleep(0.5)
            killed = kill_node(second_node)
            until(all_ended, "all jobs have ended", 900)
            print(f"{len(names)} experiments in {time.monotonic() - begin:.0f} s on two nodes, one of them killed with {killed} processes")
        for name in names:
            if not os.path.exists(f"{folder}/plan/results/{name}/table.csv"):
                for log in sorted(os.listdir(f"{folder}/plan/log")):
                    with open(f"{folder}/plan/log/{log}", encoding="utf-8") as stream:
                        print(log, stream.read()[-1000:])
                raise AssertionError(f"{name}: there is no table")
        for name in names:
            got, wanted = errors(f"{folder}/plan/results", name), errors(whole, name)
            assert got == wanted, f"{name}: tables differ:\n{got}\n{wanted}"
            print(f"{name}: {len(got)} rows are equal")


if __name__ == "__main__":
    main()
