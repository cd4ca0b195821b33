# shellcheck shell=bash
# Sourced by the Slurm tests: a real cluster of one controller and NODES slurmd on this machine, in its own
# folder and on ports of the loopback interface.
#   start_cluster FOLDER NODES   writes the settings, starts munged, slurmctld and slurmd; exports SLURM_CONF
#   stop_cluster                 ends what start_cluster started
#   use_folder NAME              sets `folder`; when the script ends, stops the cluster and deletes the folder with its
#                                mounts, or prints its name after an error
# Needs root (slurmd starts jobs of users) and the packages slurm-wlm and munge.

cluster_folder='' cluster_processes=()

# Ports that are free now, one per line.
free_ports() {
  /usr/bin/python3 - "$1" <<'PYTHON'
import socket, sys
sockets = [socket.socket() for _ in range(int(sys.argv[1]))]
for each in sockets:
    each.bind(("127.0.0.1", 0))
    print(each.getsockname()[1])
PYTHON
}

# Starts a daemon that stays in the foreground, with its output in a log.
start_daemon() {
  local log=$1
  shift
  setsid "$@" >>"$log" 2>&1 &
  cluster_processes+=("$!")
  disown "$!"  # no message when a test kills it
}

start_node() { start_daemon "$cluster_folder/$1.out" slurmd -D -N "$1" -f "$SLURM_CONF"; }

start_cluster() {
  cluster_folder=$1
  local nodes=$2 ports cores host process
  mkdir -p "$cluster_folder"/{state,munge}
  chmod 0755 "$cluster_folder" && chmod 0711 "$cluster_folder/munge"
  mapfile -t ports < <(free_ports $((nodes + 1)))
  host=$(hostname -s) cores=$(nproc)
  head -c 1024 /dev/urandom >"$cluster_folder/munge/key"
  chmod 0400 "$cluster_folder/munge/key"
  export SLURM_CONF=$cluster_folder/slurm.conf
  cat >"$SLURM_CONF" <<CONF
ClusterName=loopbench_test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=${ports[0]}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$cluster_folder/munge/socket
CredType=cred/munge
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
ReturnToService=2
StateSaveLocation=$cluster_folder/state
SlurmdSpoolDir=$cluster_folder/spool-%n
SlurmctldPidFile=$cluster_folder/slurmctld.pid
SlurmdPidFile=$cluster_folder/slurmd-%n.pid
SlurmctldLogFile=$cluster_folder/slurmctld.log
SlurmdLogFile=$cluster_folder/slurmd-%n.log
SlurmctldTimeout=30
SlurmdTimeout=20
InactiveLimit=0
KillWait=5
MinJobAge=3600
BatchStartTimeout=20
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,bf_interval=2,sched_min_interval=100000
SelectType=select/cons_res
SelectTypeParameters=CR_Core
JobRequeue=1
MaxArraySize=10001
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
CONF
  local i memory
  memory=$(awk '/^MemTotal/ { print int(0.9 * $2 / 1024) }' /proc/meminfo)
  for ((i = 1; i <= nodes; ++i)); do
    echo "NodeName=n$i NodeHostname=$host NodeAddr=127.0.0.1 Port=${ports[i]} CPUs=$cores RealMemory=$memory State=UNKNOWN" >>"$SLURM_CONF"
    mkdir -p "$cluster_folder/spool-n$i"
  done
  echo "PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP OverSubscribe=FORCE:8" >>"$SLURM_CONF"
  start_daemon "$cluster_folder/munged.out" munged --foreground --force --num-threads=2 \
    --key-file="$cluster_folder/munge/key" --socket="$cluster_folder/munge/socket" \
    --pid-file="$cluster_folder/munge/pid" --seed-file="$cluster_folder/munge/seed" \
    --log-file="$cluster_folder/munge/log"
  for ((i = 0; i < 100; ++i)); do [[ -S $cluster_folder/munge/socket ]] && break; sleep 0.1; done
  start_daemon "$cluster_folder/slurmctld.out" slurmctld -D -c -f "$SLURM_CONF"
  for ((i = 1; i <= nodes; ++i)); do start_node "n$i"; done
  for ((i = 0; i < 600; ++i)); do
    (($(sinfo --noheader --Node --format='%T' 2>/dev/null | grep -c '^idle') == nodes)) && return 0
    for process in "${cluster_processes[@]}"; do
      kill -0 "$process" 2>/dev/null || { tail -n 3 "$cluster_folder"/*.out >&2; return 1; }
    done
    sleep 0.2
  done
  echo "the cluster did not start; see $cluster_folder" >&2
  return 1
}

stop_cluster() {
  [[ -n $cluster_folder ]] || return 0
  local process
  scancel --user=root --full >/dev/null 2>&1 || true
  sleep 1
  for process in "${cluster_processes[@]}"; do kill -TERM "$process" 2>/dev/null || true; done
  sleep 2
  for process in "${cluster_processes[@]}"; do kill -KILL "$process" 2>/dev/null || true; done
  wait 2>/dev/null || true
  cluster_folder='' cluster_processes=()
}

use_folder() {
  folder=$(mktemp -d "/tmp/loopbench-$1.XXXXXX")
  trap leave_folder EXIT
}

leave_folder() {
  local code=$? mounted
  stop_cluster
  while read -r _ mounted _; do
    [[ $mounted != "$folder"/* ]] || umount -l "$mounted" || true
  done </proc/mounts
  ((code)) && { echo "failed; the files are in $folder"; exit "$code"; }
  rm -rf "$folder"
}
