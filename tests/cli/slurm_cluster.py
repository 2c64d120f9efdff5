"""A Slurm cluster of this machine alone: munged, slurmctld and two slurmd in a temporary folder, started and stopped by a test."""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import tempfile
import time

DAEMONS = ("munged", "slurmctld", "slurmd", "sbatch")

# Processes are found by their parents, as a container may have no control groups. A job that is put back into the queue waits for cred_expire.
CONFIGURATION = """\
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=6
CryptoType=crypto/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool.%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SwitchType=switch/none
ReturnToService=2
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerParameters=sched_interval=1,batch_sched_delay=0,bf_interval=1,sched_min_interval=0
SlurmdParameters=config_overrides
KillWait=5
MinJobAge={age}
InactiveLimit=0
SlurmctldTimeout=30
SlurmdTimeout=30
MaxArraySize={largest}
NodeName=n[1-2] NodeHostname={host} NodeAddr=127.0.0.1 Port=[{first}-{second}] CPUs=2 RealMemory=4000 State=UNKNOWN
PartitionName=work Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def missing():
    """Why no cluster can be started here, None if one can."""
    absent = [name for name in DAEMONS if not shutil.which(name, path=os.environ.get("PATH", "") + ":/usr/sbin")]
    if absent:
        return f"{', '.join(absent)}: not installed (tools/dev/packages.sh all)"
    return None if os.getuid() == 0 else "Slurm's daemons are started as root only"


def free_ports(count):
    """Ports in a row that nothing listens to; tests that run at once begin at others."""
    for first in range(26817 + os.getpid() % 1000 * count, 31000, count):
        sockets = [socket.socket() for _ in range(count)]
        try:
            for number, one in enumerate(sockets):
                one.bind(("127.0.0.1", first + number))
            return list(range(first, first + count))
        except OSError:
            continue
        finally:
            for one in sockets:
                one.close()
    raise RuntimeError("no free ports")


class Cluster:
    def __init__(self, age=300, largest=1001):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="vdbsynth_slurm_"))
        os.chmod(self.folder, 0o755)
        self.processes = {}
        self.environment = dict(os.environ, SLURM_CONF=str(self.folder / "slurm.conf"), PATH=os.environ["PATH"] + ":/usr/sbin")
        (self.folder / "state").mkdir()
        controller, first, second = free_ports(3)
        (self.folder / "slurm.conf").write_text(CONFIGURATION.format(
            folder=self.folder, host=socket.gethostname().split(".")[0], controller=controller, first=first, second=second, age=age,
            largest=largest))
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        try:
            self.start("munged", "--foreground", "--force", f"--socket={self.folder}/munge.socket", f"--key-file={key}",
                       f"--pid-file={self.folder}/munged.pid", f"--log-file={self.folder}/munged.log", f"--seed-file={self.folder}/munged.seed")
            self.wait(lambda: (self.folder / "munge.socket").exists(), "munged")
            self.start_controller()
            for node in ("n1", "n2"):
                self.start_node(node)
            self.wait(lambda: self.run("sinfo", "-h", "-N", "-o", "%T").stdout.split() == ["idle", "idle"], "two idle nodes")
        except Exception:
            self.stop()
            raise

    def start(self, name, *words, as_name=None):
        log = open(self.folder / f"{as_name or name}.out", "w")
        self.processes[as_name or name] = subprocess.Popen([name, *words], env=self.environment, stdin=subprocess.DEVNULL, stdout=log, stderr=log)
        log.close()

    def start_controller(self, recover=False):
        self.start("slurmctld", "-D", *([] if recover else ["-i"]))

    def start_node(self, node):
        self.start("slurmd", "-D", "-N", node, as_name=node)

    def kill(self, name, number=signal.SIGKILL):
        process = self.processes.pop(name)
        process.send_signal(number)
        process.wait(30)

    def wait(self, met, what, seconds=30):
        end = time.monotonic() + seconds
        while not met():
            if time.monotonic() > end:
                raise RuntimeError(f"waited {seconds} s for {what}: {self.logs()}")
            time.sleep(0.05)

    def logs(self):
        return "\n".join(f"{path.name}: {path.read_text(errors='replace')[-1500:]}" for path in sorted(self.folder.glob("*.log")) + sorted(self.folder.glob("*.out")))

    def run(self, *words):
        return subprocess.run([str(word) for word in words], env=self.environment, capture_output=True, text=True, timeout=60)

    def queue(self):
        """Tasks in the queue: (id, state, name)."""
        text = self.run("squeue", "-h", "-r", "-o", "%i %T %j").stdout
        return [tuple(line.split(None, 2)) for line in text.splitlines()]

    def stop(self):
        if "slurmctld" in self.processes:
            self.run("scancel", "--user=root")
            end = time.monotonic() + 10
            while self.queue() and time.monotonic() < end:
                time.sleep(0.1)
        for name in ("n1", "n2", "slurmctld", "munged"):
            if name in self.processes:
                process = self.processes.pop(name)
                process.terminate()
                try:
                    process.wait(15)
                except subprocess.TimeoutExpired:
                    process.kill()
                    process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)
