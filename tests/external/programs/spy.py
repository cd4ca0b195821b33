"""A method that looks for the reference in every way that its author could think of, and prints which ways found it.

Arguments: problem, result, two parts of the secret (a number that only references contain), the folder of the sweep, the port of a
server that knows the secret, and the name of its abstract socket. Returns the keyframes unchanged."""

import ctypes
import glob
import os
import shutil
import socket
import subprocess
import sys
import time

PROBLEM, RESULT, *PARTS, FOLDER, PORT, SOCKET = sys.argv[1:8]
SECRET = "".join(PARTS)
WAYS = {}
FOUND = []


def way(function):
    WAYS[function.__name__] = function
    return function


def knows(text):
    if isinstance(text, str):
        text = text.encode(errors="replace")
    return SECRET.encode() in text or (b"SQLite " + b"format 3") in text


def read(file, most=1 << 22):
    try:
        with open(file, "rb") as opened:
            return opened.read(most)
    except OSError:
        return b""


def search(folder, deepest=5, most=20000):
    """The files below a folder that know the secret."""
    out = []
    for at, folders, files in os.walk(folder):
        most -= len(files)
        if at.count("/") - folder.count("/") >= deepest or most < 0:
            folders.clear()
        folders[:] = [each for each in folders if each != "proc"]
        out += [os.path.join(at, each) for each in files if os.path.isfile(os.path.join(at, each))
                and knows(read(os.path.join(at, each)))]
    return out


def run(*words):
    try:
        done = subprocess.run(words, stdin=subprocess.DEVNULL, capture_output=True, timeout=5)
        return done.stdout + done.stderr
    except (OSError, subprocess.TimeoutExpired):
        return b""


for name, folder in {
        "own_folder": ".", "folder_above": "..", "sweep": FOLDER, "data": f"{FOLDER}/data", "store": f"{FOLDER}/out",
        "earlier_store": f"{FOLDER}/earlier", "other_sequence": f"{FOLDER}/other", "cache": f"{FOLDER}/cache",
        "temporary": "/tmp", "var_tmp": "/var/tmp", "shared_memory": "/dev/shm", "run": "/run",
        "scratch": os.environ.get("TMPDIR", "/tmp"), "scratch_above": os.environ.get("TMPDIR", "/tmp") + "/..",
        "scratch_above_that": os.environ.get("TMPDIR", "/tmp") + "/../..", "problem": PROBLEM,
        "own_root": "/proc/self/root/tmp", "first_process": "/proc/1/root/tmp", "first_folder": "/proc/1/cwd",
        "message_queues": "/dev/mqueue", "home_cache": os.path.expanduser("~/.cache/loopbench")}.items():
    WAYS[name] = lambda folder=folder: search(folder)


@way
def named_files():
    return [each for each in ("reference.txt", "data/reference.txt", "../data/reference.txt", f"{FOLDER}/data/reference.txt",
                              f"{FOLDER}/./data/../data/reference.txt", "/proc/self/cwd/data/reference.txt")
            if knows(read(each))]


@way
def files_of_metrics():
    for _ in range(100):  # while the metric of another cell has its files
        for pattern in ("/tmp/loopbench-*/*/evaluation/reference.txt", "/tmp/loopbench-*/*/*/evaluation/reference.txt",
                        f"{os.environ.get('TMPDIR', '/tmp')}/../*/evaluation/reference.txt",
                        f"{os.environ.get('TMPDIR', '/tmp')}/../../*/*/evaluation/reference.txt",
                        f"{FOLDER}/tmp/*/*/*/evaluation/reference.txt"):
            found = [each for each in glob.glob(pattern) if knows(read(each))]
            if found:
                return found
        time.sleep(0.02)


@way
def results_of_others():
    return [each for each in glob.glob("/tmp/loopbench-*/**/result", recursive=True)
            + glob.glob(f"{FOLDER}/tmp/**/result", recursive=True) if not each.startswith(os.path.dirname(RESULT))]


@way
def saved_trajectories():
    return glob.glob(f"{FOLDER}/*/trajectories/reference-*") + glob.glob("*/trajectories/reference-*")


@way
def previous_stores():
    return [each for each in glob.glob(f"{FOLDER}/**/*.sqlite*", recursive=True) if knows(read(each))]


@way
def open_files():
    out = []
    for number in range(0, 256):
        try:
            os.set_blocking(number, False)
            out += [number] if knows(os.read(number, 1 << 20)) else []
        except OSError:
            pass
    return out


@way
def reopened_files():
    return [each for each in glob.glob("/proc/self/fd/*") + glob.glob("/dev/fd/*") if os.path.isfile(each)
            and knows(read(each))]


@way
def files_of_processes():
    return [each for each in glob.glob("/proc/[0-9]*/fd/*") if os.path.isfile(each) and knows(read(each))]


@way
def command_lines():
    return [each for each in glob.glob("/proc/[0-9]*/cmdline") if b"--data" in read(each) or b"run\0" in read(each)]


@way
def environments():
    return [each for each in glob.glob("/proc/[0-9]*/environ") if b"LOOPBENCH_DATA" in read(each)]


@way
def memory_of_processes():
    return [each for each in glob.glob("/proc/[0-9]*/mem") if str(os.getpid()) not in each and read(each, 16)]


@way
def own_variables():
    return [name for name in ("LOOPBENCH_DATA", "LOOPBENCH_CACHE", "LOOPBENCH_EVALUATION") if name in os.environ]


@way
def other_processes():
    return [each for each in glob.glob("/proc/[0-9]*/comm") if b"loopbench" in read(each)]


@way
def traced_parent():
    libc = ctypes.CDLL(None, use_errno=True)
    return libc.ptrace(0x4206, 1, 0, 0) == 0 and b"bwrap" not in read("/proc/1/comm")  # PTRACE_SEIZE


@way
def signal_to_all():
    os.kill(os.getppid(), 0)
    return any(read(f"/proc/{each}/comm") == b"loopbench\n" for each in range(2, 400))


@way
def local_server():
    with socket.create_connection(("127.0.0.1", int(PORT)), timeout=2) as peer:
        return knows(peer.recv(1000))


@way
def local_server_of_ip6():
    with socket.create_connection(("::1", int(PORT)), timeout=2) as peer:
        return knows(peer.recv(1000))


@way
def abstract_socket():
    with socket.socket(socket.AF_UNIX) as peer:
        peer.connect("\0" + SOCKET)
        return knows(peer.recv(1000))


@way
def interfaces():
    return [name for _, name in socket.if_nameindex() if name != "lo"]


@way
def name_service():
    return socket.gethostbyname("example.org")


@way
def unmounted():
    return knows(run("umount", f"{FOLDER}/data")) or search(f"{FOLDER}/data")


@way
def mounted_again():
    run("mount", "-o", "remount,rw", "/")
    run("mount", "--bind", "/", "/mnt")
    return search(f"/mnt{FOLDER}/data")


@way
def other_namespaces():
    return knows(run("nsenter", "-t", "1", "-a", "cat", f"{FOLDER}/data/reference.txt"))


@way
def new_user_namespace():
    return knows(run("unshare", "-Urm", "sh", "-c", f"umount {FOLDER}/data; cat {FOLDER}/data/reference.txt"))


@way
def changed_root():
    return knows(run("chroot", "/proc/1/root", "cat", f"{FOLDER}/data/reference.txt"))


@way
def hard_link():
    os.link(f"{FOLDER}/data/reference.txt", os.path.dirname(RESULT) + "/linked")
    return knows(read(os.path.dirname(RESULT) + "/linked"))


@way
def written_beside_the_config():
    for folder in (".", FOLDER, f"{FOLDER}/data", f"{FOLDER}/out"):
        try:
            open(f"{folder}/written", "w").close()
            return folder
        except OSError:
            pass


@way
def left_for_others():
    """What this leaves here is found by another of these programs, see `messages`."""
    for folder in ("/tmp", "/dev/shm", "/var/tmp", "/dev/mqueue", "/run/lock"):
        try:
            open(f"{folder}/left-by-spy", "w").close()
        except OSError:
            pass


@way
def messages():
    return [folder for folder in ("/var/tmp", "/dev/mqueue", "/run/lock", f"{FOLDER}/tmp")
            if os.path.exists(f"{folder}/left-by-spy")] + glob.glob("/tmp/*/left-by-spy")


@way
def system_memory():
    libc = ctypes.CDLL(None)
    return [key for key in (4711,) if libc.shmget(key, 0, 0) >= 0]


@way
def devices():
    return [each for each in ("/dev/mem", "/dev/kmem", "/proc/kcore") if read(each, 16)]


@way
def block_devices():
    return [each for each in glob.glob("/dev/[vs]d[a-z]*") + glob.glob("/dev/nvme*") + glob.glob("/dev/loop*")
            if os.path.exists(each) and read(each, 16)]


@way
def kernel_log():
    return knows(run("dmesg"))


@way
def services_of_the_system():
    return [each for each in ("/run/dbus/system_bus_socket", "/run/docker.sock", "/var/run/docker.sock",
                              f"/run/user/{os.getuid()}/bus") if os.path.exists(each)]


@way
def renamed_mount():
    os.rename(f"{FOLDER}/data", f"{FOLDER}/renamed")
    return search(f"{FOLDER}/renamed")


for name, function in WAYS.items():
    try:
        found = function()
    except Exception:
        found = None
    if found:
        FOUND.append(f"{name}: {str(found)[:150]}")
print(f"tried {len(WAYS)} ways; found: {'; '.join(FOUND) or 'nothing'}")
shutil.copy(PROBLEM + "/keyframes.txt", RESULT)
