"""A study on many machines: the tasks of one study by GNU parallel, and as an array of a Slurm that runs on this machine alone."""

import getpass
import pathlib
import shutil
import socket
import tempfile
import time

from study_cases import *

GUIDE = (pathlib.Path(__file__).resolve().parents[2] / "docs/guide/studies.md").read_text()

CASE = shaken("m1.csv")

PLAN = (IDA.replace('case = "../case.toml"\n', 'case = "../case.toml"\nsamples = 2\n').replace(', "../m4.csv"', "") + """\
[[variable]]
name = "K"
paths = ["interface[0].law.K_n"]
distribution = { type = "lognormal", median = 1, beta = 0.4 }
""")

# In the place of the program: the first task of the shard 2/3 is lost after its first result, killed or as it hangs.
UNLUCKY = """\
#!/bin/sh
case "$*" in *"--shard 2/3"*)
  if mkdir "{folder}/unlucky" 2>/dev/null; then
    "{program}" "$@" & task=$!
    until [ -s "{folder}"/pier.study/parts/*-$task.jsonl ] || ! kill -0 $task 2>/dev/null; do sleep 0.01; done
    kill -9 $task
    [ -z "$SLURM_JOB_ID" ] || {{ touch "{folder}/hangs"; sleep 60; }}
    exit 1
  fi
esac
exec "{program}" "$@"
"""

SLURM = """\
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=main Nodes={host} Default=YES MaxTime=INFINITE State=UP
SlurmUser={user}
SlurmdUser={user}
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.sock,cred_expire=5
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmdParameters=config_overrides
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/builtin
SchedulerParameters=batch_sched_delay=0,sched_interval=1
SwitchType=switch/none
MpiDefault=none
MailProg=/bin/true
KillWait=1
ReturnToService=2
"""


def free_ports(count):
    """Ports that nobody listens to now."""
    sockets = [socket.socket() for _ in range(count)]
    for each in sockets:
        each.bind(("127.0.0.1", 0))
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


class Slurm:
    """A Slurm of one node, this machine, with all its files in a folder."""

    def __init__(self, folder):
        self.folder = folder
        for name in ("state", "spool"):
            (folder / name).mkdir(parents=True)
        key = folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        conf = folder / "slurm.conf"
        conf.write_text(SLURM.format(host=socket.gethostname().split(".")[0], user=getpass.getuser(), folder=folder, ports=free_ports(2)))
        self.environment = {**os.environ, "SLURM_CONF": str(conf)}
        self.processes = []
        try:
            self.begin(key, conf)
        except BaseException:
            self.end()
            raise

    def begin(self, key, conf):
        folder = self.folder
        self.start("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={folder}/munge.sock", f"--pid-file={folder}/munged.pid",
                   f"--log-file={folder}/munged.log", f"--seed-file={folder}/munge.seed")
        wait_until(lambda: (folder / "munge.sock").exists(), self.log)
        self.start("slurmctld", "-D", "-f", str(conf))
        self.start("slurmd", "-D", "-f", str(conf))
        wait_until(lambda: self.said("sinfo", "-h", "-o", "%t", check=False) == "idle", self.log)

    def start(self, program, *words):
        path = shutil.which(program, path=os.environ["PATH"] + ":/usr/sbin:/sbin")
        with open(self.folder / f"{program}.out", "w") as out:
            self.processes.append(subprocess.Popen([path, *words], env=self.environment, stdin=subprocess.DEVNULL, stdout=out, stderr=out))

    def said(self, *words, check=True, **more):
        done = subprocess.run(words, env=self.environment, capture_output=True, text=True, **more)
        if check and done.returncode != 0:
            raise AssertionError(f"{words}: {done.stderr}")
        return done.stdout.strip()

    def log(self):
        return "".join(file.read_text() for file in self.folder.glob("*.out"))

    def end(self):
        self.said("scancel", "--user", getpass.getuser(), check=False)
        for process in reversed(self.processes):
            process.terminate()
        for process in self.processes:
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def wait_until(is_so, tell, seconds=60):
    limit = time.monotonic() + seconds
    while not is_so():
        if time.monotonic() > limit:
            raise AssertionError("it took too long: " + tell())
        time.sleep(0.1)


class StudyQueues(CliTest):
    def setUp(self):
        super().setUp()
        self.write(CASE)
        for i, (frequency, decay) in enumerate([(1.5, 2), (3, 3), (6, 3)], 1):
            self.write(motion(frequency, decay), f"m{i}.csv")
        for name in ("whole.study", "pier.study"):
            self.write(PLAN, f"{name}/plan.toml")
        self.uplift("study", "run", "whole.study", "-q")
        unlucky = self.folder / "bin" / "uplift"
        unlucky.parent.mkdir()
        unlucky.write_text(UNLUCKY.format(folder=self.folder, program=os.path.abspath(program())))
        unlucky.chmod(0o755)
        self.environment = {**os.environ, "PATH": f"{unlucky.parent}:{os.environ['PATH']}"}

    def evaluated(self, name):
        for verb in ("index", "fit", "export"):
            self.uplift("study", verb, name, "-q")
        return {file: (self.folder / name / file).read_bytes() for file in ("fits.csv", "runs.csv", "curves.csv")}

    def assert_whole(self):
        self.assertIn("6/6 curves complete", self.uplift("study", "status", "pier.study").stdout)
        self.assertEqual(self.evaluated("pier.study"), self.evaluated("whole.study"))

    def test_gnu_parallel(self):
        tasks = self.uplift("study", "tasks", "pier.study", "--count", "3").stdout
        queue = ["parallel", "--will-cite", "-j2", "--joblog", "log"]
        first = subprocess.run(queue, input=tasks, cwd=self.folder, env=self.environment, capture_output=True, text=True)
        self.assertEqual(first.returncode, 1, first.stderr)  # one task has failed
        again = subprocess.run([*queue, "--resume-failed"], input=tasks, cwd=self.folder, env=self.environment, capture_output=True, text=True)
        self.assertEqual(again.returncode, 0, again.stderr)
        log = [line.split("\t") for line in (self.folder / "log").read_text().splitlines()[1:]]
        self.assertEqual(sorted((entry[0], entry[6]) for entry in log), [("1", "0"), ("2", "0"), ("2", "1"), ("3", "0")])
        self.assert_whole()

    def test_slurm_array(self):
        script = re.search(r"^```sh fragment\n(#!.*?)^```", GUIDE, re.M | re.S).group(1)
        self.write(script, "pier.sh")
        folder = pathlib.Path(tempfile.mkdtemp(prefix="slurm-"))  # its configuration takes no space in a path
        self.addCleanup(shutil.rmtree, folder, ignore_errors=True)
        slurm = Slurm(folder)
        self.addCleanup(slurm.end)
        slurm.environment["PATH"] = self.environment["PATH"]
        job = slurm.said("sbatch", "--parsable", "--array=1-3", "pier.sh", cwd=self.folder)
        wait_until((self.folder / "hangs").exists, slurm.log)
        slurm.said("scontrol", "requeue", f"{job}_2")
        wait_until(lambda: slurm.said("squeue", "-h") == "", slurm.log)
        states = slurm.said("scontrol", "show", "job", job)
        self.assertEqual(states.count("JobState=COMPLETED"), 3, states)
        self.assertIn("Restarts=1", states)
        self.assert_whole()


if __name__ == "__main__":
    main()
