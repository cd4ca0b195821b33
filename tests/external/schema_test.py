"""Every shipped config satisfies the schema; a mistake is found by the schema and by `run`.

Usage: schema_test.py LOOPBENCH ROOT
"""

import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import jsonschema
    import yaml
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

LOOPBENCH, ROOT = Path(sys.argv[1]), Path(sys.argv[2])
SHIPPED = ROOT / "configs/schema.json"


class Yaml12(yaml.SafeLoader):
    """Plain scalars as in YAML 1.2: 1e-3 is a number, `off` and 2024-01-01 are texts."""

    yaml_implicit_resolvers = {}


for tag, pattern, first in (
    ("bool", r"^(?:true|false)$", "tf"),
    ("int", r"^[-+]?[0-9]+$", "-+0123456789"),
    ("float", r"^[-+]?(?:[0-9]*\.[0-9]+|[0-9]+\.?)(?:[eE][-+]?[0-9]+)?$", "-+.0123456789"),
    ("merge", r"^<<$", "<"),
):
    resolver = re.compile(pattern)
    Yaml12.add_implicit_resolver(f"tag:yaml.org,2002:{tag}", resolver, list(first))


def output(*words):
    return subprocess.run([LOOPBENCH, *words], capture_output=True, text=True, check=True).stdout


LISTED = output("list", "--json")
PRINTED = subprocess.run([sys.executable, "-B", ROOT / "configs/make_schema.py"], input=LISTED,
                         capture_output=True, text=True, check=True).stdout
SCHEMA = json.loads(PRINTED)
VALIDATOR = jsonschema.Draft7Validator(SCHEMA)


def complaints(text):
    """All messages of the schema about a config, with those of the alternatives that it tried."""
    waiting = list(VALIDATOR.iter_errors(yaml.load(text, Yaml12)))
    out = ""
    while waiting:
        error = waiting.pop()
        out += f"{'.'.join(map(str, error.absolute_path))}: {error.message}\n"
        waiting += error.context
    return out


def config(**changes):
    """A valid config with some keys replaced, as text."""
    return json.dumps(
        {"datasets": [{"dataset": "simulated"}], "methods": ["raw"], "metrics": ["ate"], **changes}
    )


class Schema(unittest.TestCase):
    def test_the_shipped_file_is_what_the_script_prints(self):
        self.assertEqual(
            SHIPPED.read_text(),
            PRINTED,
            "update it: loopbench list --json | python3 configs/make_schema.py >configs/schema.json",
        )
        VALIDATOR.check_schema(SCHEMA)

    def test_shipped_configs_name_it_and_satisfy_it(self):
        files = sorted((ROOT / "configs").rglob("*.yaml"))
        self.assertGreater(len(files), 20)
        for file in files:
            text = file.read_text()
            first = text.split("\n", 1)[0]
            self.assertTrue(first.startswith("# yaml-language-server: $schema="), file)
            self.assertEqual((file.parent / first.split("=")[1]).resolve(), SHIPPED.resolve(), file)
            self.assertEqual(complaints(text), "", file)

    def test_defaults_of_all_options_satisfy_it(self):
        listed = json.loads(LISTED)
        for kind in ("datasets", "methods", "metrics"):
            entries = [
                {kind[:-1]: entry["name"], "label": entry["name"]}
                | {option["name"]: option["default"] for option in entry["options"]}
                for entry in listed[kind]
            ]
            self.assertEqual(complaints(config(**{kind: entries})), "", kind)

    def test_options_are_listed_with_type_unit_range_and_choices(self):
        listed = json.loads(LISTED)
        found = {f"{entry['name']}.{option['name']}": option
                 for subject in ("datasets", "methods", "metrics", "protocols")
                 for entry in listed[subject] for option in entry["options"]}
        self.assertEqual({option["type"] for option in found.values()}, {"boolean", "integer", "number", "text"})
        for name, expected in (
            ("simulated.keyframes", {"type": "integer", "minimum": 0}),
            ("rpe.delta", {"type": "number", "exclusive_minimum": 0}),
            ("dm.chord_above", {"type": "number", "none": True}),
            ("jerk.rate", {"unit": "1/s", "default": 10}),
            ("graph_cost.error", {"type": "text", "choices": ["twist", "quaternion", "chordal"]}),
        ):
            self.assertEqual(found[name] | expected, found[name])
        self.assertEqual(set(listed["keys"]), {"config", "limits", "timing", "table", "exclude"})

    def test_what_run_accepts_satisfies_it(self):
        for text in (
            config(plugins="mine.so", methods=["of_a_plugin"]),
            config(_anchors={"any": 1}, times=["dense"], timing={"runs": 3, "serial": True}),
            config(methods=[{"method": "dual + dm", "sweep": {"turn_max": [0.1, 0.2]}}]),
            config(methods=[{"method": "dual + dm", "dm.turn_max": 0.1, "dm": {"chord_above": "none"}}]),
            config(datasets=[{"dataset": "simulated", "noise": {"gain": 0}, "white_noise.sigma_t": 0.1}]),
            config(protocol=["evo", {"base": "tum", "segments": {"step": 5}}]),
            config(metrics=[{"metric": "rpe", "zip": {"delta": {"from": 1, "to": 5, "steps": 5}}}]),
        ):
            self.assertEqual(complaints(text), "", text)

    def test_mistakes_are_found_by_the_schema_and_by_run(self):
        """By the schema at a path, and with the same word; what `run` suggests, the schema accepts."""
        for path, word, right, text in (
            ("", "methds", "methods", config(methds=["raw"])),
            ("methods.0", "unifrom", "uniform", config(methods=["unifrom"])),
            ("methods.0.method", "unifrom", "uniform", config(methods=[{"method": "unifrom"}])),
            ("methods.0", "cubic", "cubic_spline", config(methods=["dual + cubic"])),
            ("metrics.0", "aet", "ate", config(metrics=["aet"])),
            ("datasets.0.dataset", "simulatd", "simulated", config(datasets=[{"dataset": "simulatd"}])),
            ("methods.0", "turn_mux", "turn_max", config(methods=[{"method": "dm", "turn_mux": 1}])),
            ("methods.0", "turn_mix", "turn_max", config(methods=[{"method": "dual + dm", "turn_mix": 1}])),
            ("metrics.0", "dleta", "delta", config(metrics=[{"metric": "rpe", "dleta": 1}])),
            ("datasets.0.noise", "gian", "gain", config(datasets=[{"dataset": "simulated", "noise": {"gian": 0}}])),
            ("protocol", "alignn", "align", config(protocol={"alignn": "se3"})),
            ("protocol", "evoo", "evo", config(protocol="evoo")),
            ("limits", "memori", "memory", config(limits={"memori": "1GiB"})),
            ("table", "colums", "columns", config(table={"colums": "score"})),
            ("times", "times", "dense", config(times="dence")),
            ("datasets.0.path", "rom", "room", config(datasets=[{"dataset": "simulated", "path": "rom"}])),
            ("methods.0.turn_max", "wide", "number", config(methods=[{"method": "dm", "turn_max": "wide"}])),
            ("datasets.0.sweep.keyframes.0", "1.5", "",
             config(datasets=[{"dataset": "simulated", "sweep": {"keyframes": [1.5]}}])),
            ("metrics.0.delta", "-1", "0", config(metrics=[{"metric": "rpe", "delta": -1}])),
            ("min_coverage", "2", "1", config(min_coverage=2)),
            ("repeats", "repeats", "1", config(repeats=0)),
        ):
            with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
                file.write(text)
                file.flush()
                done = subprocess.run(
                    [LOOPBENCH, "run", file.name, "--dry-run"], capture_output=True, text=True
                )
            self.assertEqual(done.returncode, 2, text)
            self.assertIn(word, done.stderr)
            self.assertIn(right, done.stderr)
            (error,) = VALIDATOR.iter_errors(yaml.load(text, Yaml12))
            self.assertEqual(".".join(map(str, error.absolute_path)), path, text)
            self.assertIn(word, f"{path}: {error.message}")
            self.assertIn(right, error.message + str(list(error.schema.get("properties", ()))))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
