"""The private world of programs: none finds the reference, files of other cells, stores or the network. Arguments:
loopbench and the folder of tests/external/programs. Needs bubblewrap."""

import json
import os
import shutil
import socket
import sqlite3
import subprocess
import sys
import tempfile
import threading
import unittest
from pathlib import Path

PROGRAM, PROGRAMS = (os.path.abspath(word) for word in sys.argv[1:3])
SECRET = "7.7712345"
NAME = f"loopbench-test-{os.getpid()}"
BAG = Path(__file__).parents[1] / "data/fuzz/bag/valid.db3"


class Server:
    """Tells the secret to everybody who asks, over TCP and an abstract socket."""

    def __init__(self):
        self.sockets = [socket.create_server(("127.0.0.1", 0)), socket.socket(socket.AF_UNIX)]
        self.port = self.sockets[0].getsockname()[1]
        self.sockets[1].bind("\0" + NAME)
        self.sockets[1].listen()
        for each in self.sockets:
            threading.Thread(target=self.tell, args=(each,), daemon=True).start()

    def tell(self, own):
        while True:
            try:
                peer, _ = own.accept()
            except OSError:
                return
            with peer:
                peer.sendall(SECRET.encode())


SERVER = Server()


class PrivatePrograms(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        for name in ("tmp", "data", "other", "cache", "prog"):
            (self.folder / name).mkdir()
        rows = [f"{t} {t % 7} {t % 5} {{}} 0 0 0 1\n" for t in range(40)]
        for folder in ("data", "other"):
            self.write(f"{folder}/estimate.txt", "".join(row.format(1) for row in rows))
            self.write(f"{folder}/reference.txt", "".join(row.format(SECRET) for row in rows))
        for name in ("spy.py",):
            shutil.copy(Path(PROGRAMS) / name, self.folder / "prog")
        self.environment = os.environ | {"TMPDIR": str(self.folder / "tmp"), "LOOPBENCH_CACHE": str(self.folder / "cache")}

    def write(self, name, text):
        (self.folder / name).write_text(text)

    def dataset(self, folder):
        return {"dataset": "trajectory", "label": folder, "estimate": f"{folder}/estimate.txt",
                "reference": f"{folder}/reference.txt"}

    def sweep(self, methods, metrics=("ate",), options="", code=0, out="out"):
        self.write("c.yaml", json.dumps({"datasets": [self.dataset("data"), self.dataset("other")], "methods": methods,
                                         "metrics": list(metrics), "times": "keyframes", "limits": {"seconds": 60}}))
        done = subprocess.run([PROGRAM, "run", "c.yaml", "--out", out, *options.split()], cwd=self.folder,
                              env=self.environment, capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stderr

    def select(self, query):
        database = sqlite3.connect(self.folder / "out/results.sqlite")
        rows = [row[0] for row in database.execute(query).fetchall()]
        database.close()
        return rows

    def outputs(self, method):
        return self.select(f"SELECT text FROM note JOIN cell ON id = cell WHERE method = '{method}' AND "
                           "text LIKE 'output: %' AND position NOT NULL")

    def spy(self, **more):
        run = f"python3 prog/spy.py {{problem}} {{result}} {SECRET[0]} {SECRET[1:]} {self.folder} {SERVER.port} {NAME}"
        return {"method": "command", "label": "spy", "run": run, **more}

    def test_no_way_leads_to_the_reference(self):
        slow = "sh -c 'sleep 1; printf %s \"$0\" >\"$2\"' '{\"scores\": [{\"name\": \"n\", \"unit\": \"1\", \"value\": 1}]}' {evaluation} {result}"
        self.sweep(["raw"], options="--save-trajectories", out="earlier")
        self.sweep(["raw"], options="--save-trajectories")
        for option in ("--fresh", "--retry all", "--data data --retry all"):
            self.sweep([self.spy(), "raw", "uniform"], ["ate", {"metric": "command", "label": "slow", "run": slow}],
                       f"--jobs 2 --save-trajectories {option}")
            said = self.outputs("spy")
            self.assertEqual(len(said), 2)
            for each in said:
                self.assertRegex(each, "tried [0-9]+ ways; found: nothing$")
            self.assertGreaterEqual(int(said[0].split()[2]), 40)
            self.assertEqual(list((self.folder / "tmp").iterdir()), [])
        self.assertEqual(self.select("SELECT DISTINCT value FROM provenance WHERE key = 'network'"), ["none"])

    def test_data_that_a_command_names_stay_hidden(self):
        self.write("prog/copy.sh", "cat $3; cp $1/keyframes.txt $2\n")
        by_word = "sh prog/copy.sh {problem} {result} data/reference.txt"
        by_line = "sh -c 'cat data/reference.txt; cp $0/keyframes.txt $1' {problem} {result}"
        self.sweep([{"method": "command", "label": f"m{i}", "run": run} for i, run in enumerate((by_word, by_line))])
        for method in ("m0", "m1"):
            for said in self.outputs(method):
                self.assertNotIn(SECRET, said)
        self.assertEqual(self.select("SELECT count(*) FROM cell WHERE status = 'ok'"), [4])

    def test_a_bag_with_the_reference_stays_hidden(self):
        """Also in the folder of the program, and if its command names it."""
        shutil.copy(BAG, self.folder / "prog/run.db3")
        topic = "bag:prog/run.db3#/pose"
        self.write("prog/copy.sh", "cat $3 2>/dev/null | wc -c; cp $1/keyframes.txt $2\n")
        self.write("c.yaml", json.dumps({
            "datasets": [{"dataset": "trajectory", "label": "a", "estimate": topic, "reference": topic}],
            "methods": [{"method": "command", "label": "m", "run": "sh prog/copy.sh {problem} {result} prog/run.db3"}],
            "metrics": ["path_length"], "times": "keyframes"}))
        done = subprocess.run([PROGRAM, "run", "c.yaml", "--out", "out"], cwd=self.folder, env=self.environment,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.outputs("m"), ["output: 0"])

    def test_services_in_run_do_not_answer(self):
        folder = Path("/run") / NAME
        try:
            (folder / "deep").mkdir(parents=True)
        except OSError:
            self.skipTest("needs permission to write in /run")
        self.addCleanup(shutil.rmtree, folder)
        places = [folder / "service.sock", folder / "deep/service.sock"]
        for place in places:
            service = socket.socket(socket.AF_UNIX)
            self.addCleanup(service.close)
            service.bind(str(place))
            service.listen()
            threading.Thread(target=SERVER.tell, args=(service,), daemon=True).start()
        self.write("prog/asks.py", f"""import shutil, socket, sys
for place in {[str(each) for each in places]}:
    with socket.socket(socket.AF_UNIX) as peer:
        try:
            peer.connect(place)
            print('heard', peer.recv(100))
        except OSError:
            print('silent', end=' ')
shutil.copy(sys.argv[1] + '/keyframes.txt', sys.argv[2])
""")
        self.sweep([{"method": "command", "label": "asks", "run": "python3 prog/asks.py {problem} {result}"}])
        for said in self.outputs("asks"):
            self.assertEqual(said.split(), ["output:", "silent", "silent"])

    def test_a_metric_can_leave_nothing_for_a_method(self):
        """Beside devices, in settings of the kernel and among its keys, where the programs of root can write."""
        self.write("prog/keys.py", """import ctypes, json, os, shutil, sys
call = ctypes.CDLL(None).syscall
add, keep, search = (lambda k: call(KEY, b'user', NAME, SECRET, len(SECRET), k)), (lambda k: call(CTL, 5, k, 0x3f3f3f3f)), (lambda k: call(CTL, 10, k, b'user', NAME, 0))
KEY, CTL = {'x86_64': (248, 250), 'aarch64': (217, 219)}[os.uname().machine]
NAME, SECRET, PLACES = b'loopbench-test', b'secret', ('/dev/loopbench-test', '/dev/pts/loopbench-test', '/dev/net/loopbench-test', '/run/loopbench-test')
found = []
for file in ('/proc/sys/kernel/hostname', '/proc/sys/kernel/core_pattern', '/proc/sys/vm/swappiness'):
    try:
        os.close(os.open(file, os.O_WRONLY))
        found.append(file)
    except OSError:
        pass
if os.path.exists(sys.argv[1] + '/keyframes.txt'):
    found += [each for each in PLACES if os.path.exists(each)] + [str(k) for k in (-4, -5) if search(k) > 0]
    print('found:', *found)
    shutil.copy(sys.argv[1] + '/keyframes.txt', sys.argv[2])
else:
    for k in (-4, -5):
        keep(add(k))
    for each in PLACES:
        try:
            open(each, 'w').close()
        except OSError:
            pass
    open(sys.argv[2], 'w').write(json.dumps({'scores': [{'name': 'n', 'unit': '1', 'value': len(found)}]}))
""")
        keys = "python3 prog/keys.py"
        self.sweep(["raw", {"method": "command", "label": "keys", "run": keys + " {problem} {result}"}],
                   ["ate", {"metric": "command", "label": "keys", "run": keys + " {evaluation} {result}"}], "--jobs 1")
        for said in self.outputs("keys"):
            self.assertTrue(said.endswith("found:"), said)
        self.assertEqual(set(self.select("SELECT rmse FROM score WHERE label = 'keys'")), {0.0})
        self.assertFalse(Path("/dev/loopbench-test").exists())

    def test_data_are_hidden_at_other_mount_points(self):
        mounts = "mkdir again && mount --bind data again"
        if subprocess.run(["unshare", "-m", "sh", "-c", mounts], cwd=self.folder, capture_output=True).returncode:
            self.skipTest("needs permission to mount")
        self.write("prog/cat.sh", "cat again/*; cp $1/keyframes.txt $2\n")
        self.write("c.yaml", json.dumps({"datasets": [self.dataset("data")], "metrics": ["ate"], "methods": [
            {"method": "command", "label": "m", "run": "sh prog/cat.sh {problem} {result}"}]}))
        command = f"mount --bind data again && exec '{PROGRAM}' run c.yaml --out out"
        done = subprocess.run(["unshare", "-m", "sh", "-c", command], cwd=self.folder, env=self.environment,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        for said in self.outputs("m"):
            self.assertNotIn(SECRET, said)

    def test_a_program_that_serves_sees_nothing_either(self):
        self.write("prog/serves.sh", f"python3 prog/spy.py /nowhere /nowhere {SECRET[0]} {SECRET[1:]} {self.folder} {SERVER.port} "
                                     f"{NAME} >&2 2>/dev/null\nexit 3\n")
        self.sweep([{"method": "command", "label": "spy", "serve": "sh prog/serves.sh"}], code=1)
        for why in self.select("SELECT why FROM cell WHERE position NOT NULL"):
            self.assertIn("found: nothing", why)

    def test_the_network_is_there_if_the_config_says_so(self):
        self.write("prog/asks.py", "import socket, sys, shutil\n"
                                   f"peer = socket.create_connection(('127.0.0.1', {SERVER.port}), 2)\n"
                                   "print('heard', peer.recv(100))\nshutil.copy(sys.argv[1] + '/keyframes.txt', sys.argv[2])\n")
        entry = {"method": "command", "label": "asks", "run": "python3 prog/asks.py {problem} {result}"}
        self.sweep([entry], code=1)
        self.sweep([{**entry, "network": True}])
        self.assertIn(SECRET, self.outputs("asks")[0])
        self.assertIn("method asks\n", self.select("SELECT DISTINCT value FROM provenance WHERE key = 'network'"))

    def test_tmp_is_writable_and_its_own(self):
        self.write("prog/own.sh", "ls -A /tmp; echo x >/tmp/x && cat /tmp/x && cp $1/keyframes.txt $2\n")
        self.sweep([{"method": "command", "label": "own", "run": "sh prog/own.sh {problem} {result}"}])
        for each in self.outputs("own"):
            self.assertTrue(each.endswith(" x"), each)
            self.assertFalse(Path("/tmp/x").exists())

    def test_a_program_is_two_processes_as_a_method_and_as_a_metric(self):
        self.write("prog/both.py", """import sys, struct, json, os
i, o, kinds = sys.stdin.buffer, sys.stdout.buffer, set()
while len(h := i.read(32)) == 32:
    number, text, data = struct.unpack('<QQQ', h[8:])
    t, d = json.loads(i.read(text)), i.read(data)
    kinds.add(t.get('kind', 'method'))
    print('asked as', *sorted(kinds), file=sys.stderr, flush=True)
    if t.get('kind') == 'metric':
        a, out = {'scores': [{'name': 'kinds', 'unit': '1', 'value': len(kinds)}]}, b''
    else:
        rows = t['arrays'][0][1]
        a, out = {'poses': rows, 'counts': {'kinds': len(kinds)}}, d[:rows * 64]
    a = json.dumps(a).encode()
    o.write(b'LBEXCH01' + struct.pack('<QQQ', number, len(a), len(out)) + a + out)
    o.flush()
""")
        serve = "python3 prog/both.py"
        self.sweep(["raw", "uniform", {"method": "command", "label": "both", "serve": serve}],
                   ["ate", {"metric": "command", "label": "both", "serve": serve}], "--jobs 1")
        self.assertEqual(set(self.select("SELECT value FROM count WHERE name = 'kinds'")), {1.0})
        self.assertEqual(set(self.select("SELECT rmse FROM score WHERE label = 'both'")), {1.0})


if subprocess.run(["bwrap", "--ro-bind", "/", "/", "--unshare-all", "true"], capture_output=True).returncode:
    sys.exit(77)
unittest.main(argv=sys.argv[:1])
