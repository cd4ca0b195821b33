#!/usr/bin/env python3
"""Prints the JSON Schema (draft 7) of configs, for editors and validators.

Usage: loopbench list --json | python3 configs/make_schema.py > configs/schema.json

With `list --json --plugin mine.so`, the schema has the names of a plugin, too. Names of entries are
checked unless a config lists plugins, whose names it cannot contain.
"""

import json
import re
import sys

FLAG = {"type": "boolean"}
COUNT = {"type": "integer", "minimum": 1, "maximum": 1_000_000}
TEXT = {"type": ["string", "number", "boolean"]}  # also one that looks like a number
TEXTS = {"type": ["string", "number", "boolean", "array"], "items": TEXT}
BOUNDS = {"minimum": "minimum", "exclusive_minimum": "exclusiveMinimum", "maximum": "maximum"}


def map_of(properties, **others):
    return {"type": "object", "properties": properties, **others, "additionalProperties": False}


def one_of(names):
    return {"enum": list(names)}


def reference(definition, *path):
    names = [name.replace("~", "~0").replace("/", "~1") for name in (definition, *path)]
    return {"$ref": "#/definitions/" + "/properties/".join(names)}


def one_or_more(item):
    return {"if": {"type": "array"}, "then": {"minItems": 1, "items": item}, "else": item}


def option_schema(option):
    out = {"description": option["description"], "default": option["default"]}
    if "choices" in option:
        return out | one_of(option["choices"])
    if option["type"] == "text":
        return out | TEXT
    out["type"] = option["type"]
    out |= {word: option[name] for name, word in BOUNDS.items() if name in option}
    return out | ({"type": ["number", "string"], "pattern": "^none$"} if option.get("none") else {})


def add_nested(properties):
    """Adds options whose names contain dots as nested maps, too: `noise.gain` as {noise: {gain: 1}}."""
    nested = {}
    for name, schema in properties.items():
        first, dot, rest = name.partition(".")
        if dot:
            nested.setdefault(first, {})[rest] = schema
    for name, inner in nested.items():
        one = map_of(add_nested(inner))
        properties[name] = {"anyOf": [properties[name], one]} if name in properties else one
    return properties


def grid_schema(options):
    """What `sweep` and `zip` contain: a map from options to lists or ranges."""
    return map_of({name: {"allOf": [reference("values")], "items": one} for name, one in options.items()})


def values_schema():
    number = {"type": "number"}
    steps = {"type": "integer", "minimum": 1, "maximum": 100_000}
    return {"type": ["array", "object"], "minItems": 1,
            "properties": {"from": number, "to": number, "steps": steps, "log": FLAG},
            "required": ["from", "to", "steps"], "additionalProperties": False}


def dataset_keys():
    align = {"$ref": "#/definitions/protocol/else/properties/align"}
    return {"group": {"description": "name of runs that are not independent"} | TEXT,
            "protocol": {"description": "rules of this dataset under every protocol"} | map_of({"align": align})}


def entry_schema(kind, entry):
    """The map of one entry, whose options are its properties."""
    name = f"{kind}.{entry['name']}"
    options = {one["name"]: option_schema(one) for one in entry["options"]}
    references = {option: reference(name, option) for option in options}
    keys = [kind, "label", "sweep", "zip"] + (list(dataset_keys()) if kind == "dataset" else [])
    properties = dict.fromkeys(keys, True)
    for key, schema in add_nested(dict(references)).items():
        properties[key] = options[key] if schema == references.get(key) else schema
    properties |= {"sweep": grid_schema(references), "zip": reference(name, "sweep")}
    return {"description": entry["summary"]} | map_of(properties)


def list_schema(kind, known, conditions):
    """A list of names, or maps whose options depend on the name."""
    properties = {kind: known, "label": {"description": "name in tables"} | TEXT}
    properties |= dataset_keys() if kind == "dataset" else {}
    one = {"type": "object", "required": [kind], "properties": properties,
           "allOf": [{"if": {"required": [kind], "properties": {kind: name}}, "then": reference(definition)}
                     for name, definition in conditions]}
    return {"type": "array", "minItems": 1,
            "items": {"type": ["string", "object"], "if": {"type": "string"}, "then": known, "else": one}}


def any_of(names):
    return "|".join(re.sub(r"([\\^$.|?*+()\[\]{}])", r"\\\1", name) for name in names)


def composed_pattern(methods):
    """Matches "corrector + smoother", and "replay + " any method or these."""
    corrector, smoother, joint, replay = (
        f"({any_of(one['name'] for one in methods if one['kind'] == kind)})"
        for kind in ("corrector", "smoother", "joint", "replay"))
    two = rf"{corrector}\s*\+\s*{smoother}"
    one = f"({corrector}|{smoother}|{joint})"
    return rf"^\s*({two}|{replay}\s*\+\s*({two}|{one}))\s*$"


def composed_schema(methods):
    """An option belongs to one of the stages, whose name can precede it. Options of the same name can
    differ between methods: the schema is that of any of them."""
    having, seen, options, swept = {}, {}, {}, {}
    for method in methods:
        for option in method["options"]:
            name, one = option["name"], reference("method." + method["name"], option["name"])
            options[f"{method['name']}.{name}"] = swept[f"{method['name']}.{name}"] = one
            swept[name] = reference("composed", name)
            having.setdefault(name, []).append(method["name"])
            accepted = {key: value for key, value in option_schema(option).items()
                        if key not in ("default", "description")}
            if accepted not in seen.setdefault(name, []):
                seen[name].append(accepted)
                options.setdefault(name, {"anyOf": []})["anyOf"].append(one)
    keys = {"method": True, "label": True} | add_nested(options)
    keys |= {"sweep": grid_schema(swept), "zip": reference("composed", "sweep")}
    stages = {name: {"properties": {"method": {"pattern": rf"(^|\+)\s*({any_of(names)})\s*($|\+)"}}}
              for name, names in having.items()}
    return map_of(keys) | {"dependencies": stages}


def protocol_schema(protocols):
    """A name, or a map with changes."""
    known = one_of(one["name"] for one in protocols)
    options = {one["name"]: option_schema(one) for one in protocols[0]["options"]}
    return {"type": ["string", "object"], "if": {"type": "string"}, "then": known,
            "else": map_of(add_nested({"base": known} | options))}


def config_keys(listed):
    """Schemas of the keys of a config and its maps, which have those of `listed` and no others."""

    def keys_of(name, schemas):
        described = {key["name"]: key["description"] for key in listed["keys"][name]}
        assert described.keys() == schemas.keys(), f"keys of {name}: {described.keys() ^ schemas.keys()}"
        return {key: {"description": text} | schemas[key] for key, text in described.items()}

    entries = {"type": "array", "minItems": 1}
    limits = map_of(keys_of("limits", {
        "seconds": {"type": "number", "minimum": 0}, "memory": {"type": ["string", "integer"]},
        "processes": COUNT, "cells": COUNT}))
    table = map_of(keys_of("table", dict.fromkeys(("rows", "columns", "split", "show", "where"), TEXTS)
                           | {"value": TEXT, "plus_minus": FLAG}))
    timing = {"anyOf": [COUNT, FLAG, map_of(keys_of("timing", {
        "runs": COUNT, "precision": {"type": "number", "minimum": 0, "maximum": 1}, "serial": FLAG}))]}
    excluded = map_of(keys_of("exclude", {"dataset": TEXT, "method": TEXT}))
    return keys_of("config", {
        "description": TEXT, "plugins": TEXTS, "datasets": entries, "methods": entries, "metrics": entries,
        "times": one_or_more(one_of(["keyframes", "dense"])), "protocol": one_or_more(reference("protocol")),
        "baseline": TEXT, "min_coverage": {"type": "number", "minimum": 0, "maximum": 1}, "repeats": COUNT,
        "timing": timing, "traces": FLAG, "limits": limits,
        "exclude": {"type": "array", "items": excluded}, "table": table})


def config_schema(listed):
    definitions = {"values": values_schema(), "protocol": protocol_schema(listed["protocols"])}
    lists = {}
    for subject in ("datasets", "methods", "metrics"):
        kind = subject[:-1]
        definitions |= {f"{kind}.{one['name']}": entry_schema(kind, one) for one in listed[subject]}
        names = [one["name"] for one in listed[subject]]
        known, conditions = one_of(names), [({"const": name}, f"{kind}.{name}") for name in names]
        if kind == "method":  # without anyOf, so that validators list the names
            pattern = {"pattern": composed_pattern(listed[subject])}
            known = {"if": {"pattern": r"\+"}, "then": pattern, "else": known}
            conditions.append(({"pattern": r"\+"}, "composed"))
        lists[subject] = list_schema(kind, known, conditions)
    definitions["composed"] = composed_schema(listed["methods"])
    keys = config_keys(listed)
    # Names with _ are for anchors. Validators list the others, as `run` does.
    return {"$schema": "http://json-schema.org/draft-07/schema#", "title": "config of loopbench",
            "type": "object", "properties": keys, "required": ["datasets", "methods", "metrics"],
            "propertyNames": {"if": {"pattern": "^_"}, "else": one_of(keys)},
            "if": {"required": ["plugins"]},  # their names are not known here
            "else": {"properties": lists}, "definitions": definitions}


def text(schema):
    """One line for each definition, so that changes can be read in the history of a file."""

    def lines(items):
        return "{\n" + ",\n".join(f"{json.dumps(name)}: {value}" for name, value in items) + "\n}"

    def line(value):
        return json.dumps(value, ensure_ascii=False, separators=(",", ":"))

    definitions = lines((name, line(one)) for name, one in schema["definitions"].items())
    return lines((name, definitions if name == "definitions" else line(one)) for name, one in schema.items())


if __name__ == "__main__":
    print(text(config_schema(json.load(sys.stdin))))
