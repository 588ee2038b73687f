//! A sweep on Slurm itself, where its daemons can be started: one controller and one node, both here.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::thread::sleep;
use std::time::Duration;

/// Daemons that end with the test.
struct Cluster {
    folder: tempfile::TempDir,
}

impl Cluster {
    /// One node of two processors; nothing, with the reason, where Slurm is not installed or does not start.
    fn start() -> Result<Self, String> {
        for program in ["sbatch", "slurmctld", "slurmd", "munged"] {
            let known = Command::new("which").arg(program).output();
            if !known.is_ok_and(|answer| answer.status.success()) {
                return Err(format!("there is no {program}"));
            }
        }
        let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
        let host = said(
            &Command::new("hostname")
                .arg("-s")
                .output()
                .map_err(|e| e.to_string())?,
        );
        let path = |name: &str| folder.path().join(name).display().to_string();
        for name in ["state", "spool"] {
            fs::create_dir(path(name)).map_err(|e| e.to_string())?;
        }
        let text = format!(
            "ClusterName=one\nSlurmctldHost={host}(127.0.0.1)\nSlurmUser=root\nSlurmdUser=root\nAuthType=auth/munge\n\
             ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nJobAcctGatherType=jobacct_gather/none\n\
             AccountingStorageType=accounting_storage/none\nSelectType=select/cons_tres\nSelectTypeParameters=CR_Core\n\
             ReturnToService=2\nMpiDefault=none\nSlurmctldPidFile={}\nSlurmdPidFile={}\nStateSaveLocation={}\n\
             SlurmdSpoolDir={}\nSlurmctldLogFile={}\nSlurmdLogFile={}\n\
             NodeName={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=500 State=UNKNOWN\n\
             PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP\n",
            path("controller.pid"),
            path("node.pid"),
            path("state"),
            path("spool"),
            path("controller.log"),
            path("node.log"),
        );
        fs::write(path("slurm.conf"), text).map_err(|e| e.to_string())?;
        let cluster = Cluster { folder };
        // Munge may run already, and then refuses a second.
        let prepare =
            "mkdir -p /run/munge && chown munge: /run/munge && runuser -u munge -- munged";
        let _ = Command::new("bash").args(["-c", prepare]).output();
        for daemon in ["slurmctld", "slurmd"] {
            let answer = cluster
                .command(daemon)
                .output()
                .map_err(|e| e.to_string())?;
            if !answer.status.success() {
                return Err(format!("{daemon}: {}", said(&answer)));
            }
        }
        for _ in 0..60 {
            let state = cluster.command("sinfo").args(["-h", "-o", "%T"]).output();
            if state.is_ok_and(|answer| said(&answer).starts_with("idle")) {
                return Ok(cluster);
            }
            sleep(Duration::from_millis(250));
        }
        Err("the node does not come up".to_owned())
    }

    fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.env("SLURM_CONF", self.folder.path().join("slurm.conf"));
        command
    }
}

impl Drop for Cluster {
    fn drop(&mut self) {
        let _ = self.command("scontrol").arg("shutdown").output();
        for name in ["controller.pid", "node.pid"] {
            if let Ok(id) = fs::read_to_string(self.folder.path().join(name)) {
                let _ = Command::new("kill").arg(id.trim()).output();
            }
        }
    }
}

fn said(answer: &Output) -> String {
    let text =
        [&answer.stdout, &answer.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    text.concat().trim().to_owned()
}

fn landau() -> PathBuf {
    PathBuf::from(env!("CARGO_BIN_EXE_landau-under-test"))
}

/// The script that is written, started as it says: an array of three tasks, and the merge that waits for them.
#[test]
fn a_sweep_on_slurm() {
    let cluster = match Cluster::start() {
        Ok(cluster) => cluster,
        Err(reason) => {
            eprintln!("SKIPPED: no sweep on Slurm, for {reason}");
            return;
        }
    };
    let folder = tempfile::tempdir().expect("a folder");
    let (plain, out) = (
        folder.path().join("plain.csv"),
        folder.path().join("a map.csv"),
    );
    let sweep = |out: &Path, more: &[&str]| {
        let mut command = cluster.command(landau().to_str().expect("a path"));
        command.args([
            "sweep",
            "swift_hohenberg",
            "--over",
            "k=0.9:1.1:40",
            "--over",
            "r=0.1:0.3:3",
        ]);
        command
            .args(["--set", "b=0.5", "--out"])
            .arg(out)
            .args(more);
        let answer = command
            .current_dir(folder.path())
            .output()
            .expect("it runs");
        assert!(answer.status.success(), "{}", said(&answer));
        said(&answer)
    };
    sweep(&plain, &[]);
    let start = sweep(&out, &["--emit", "slurm", "--tasks", "3", "--cpus", "1"]);
    let mut started = cluster.command("bash");
    let answer = started
        .args(["-c", &start])
        .current_dir(folder.path())
        .output()
        .expect("it runs");
    assert!(answer.status.success(), "{start}: {}", said(&answer));
    for _ in 0..240 {
        let left = cluster
            .command("squeue")
            .arg("-h")
            .output()
            .expect("it runs");
        if said(&left).is_empty() {
            break;
        }
        sleep(Duration::from_millis(250));
    }
    let logs = || -> String {
        let files = fs::read_dir(folder.path()).expect("listed").flatten();
        let logs = files.filter(|f| f.path().extension().is_some_and(|e| e == "out"));
        logs.filter_map(|f| fs::read_to_string(f.path()).ok())
            .collect()
    };
    assert!(out.is_file(), "{}", logs());
    assert_eq!(
        fs::read(&out).expect("merged"),
        fs::read(&plain).expect("plain"),
        "{}",
        logs()
    );
}
