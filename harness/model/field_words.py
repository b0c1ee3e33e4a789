"""What a field of a format takes, in words and by an example, and what no field is for: the remedy of a fault.

What it takes follows from the JSON Schema of the model, so that a field that is added needs no words of its own.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from functools import lru_cache
from typing import Any

from pydantic import BaseModel

from harness.model.fields import LARGEST

Schema = dict[str, Any]
Location = tuple[int | str, ...]


def remedy_at(model: type[BaseModel], location: Location) -> str:
    """What to give at a location of the data of a model, as "Give a number above 0, as 1"; empty where any value goes.

    Args:
        model: of the data; location: names of fields and numbers of entries, tags of alternatives among them.
    """
    found = fields_at(model, location)
    kinds = list(dict.fromkeys(words for field in found for words in words_of(model, field)))
    about = next((field["description"] for field in found if "description" in field and "$ref" not in field), "")
    if not kinds:
        return ""
    return f"Give {' or '.join(kinds)}" + (f": {about}" if about and "\n" not in about else "")


def names_at(model: type[BaseModel], location: Location) -> list[str]:
    """Names of the fields of the object at a location; none where there is no object or there are several kinds."""
    objects = [
        part for field in fields_at(model, location) for part in _alternatives(model, field) if "properties" in part
    ]
    return list(objects[0]["properties"]) if len(objects) == 1 else []


def fields_at(model: type[BaseModel], location: Location) -> list[Schema]:
    """The schemas that a location may mean: several where a field has alternatives."""
    found = [_schema(model)]
    for part in location:
        alternatives = [each for field in found for each in _alternatives(model, field)]
        tagged = [
            {"$ref": field["discriminator"]["mapping"][part]}
            for outer in found
            for field in _unions(model, outer)
            if part in field.get("discriminator", {}).get("mapping", {})
        ]
        inner = tagged or [each for field in alternatives for each in _parts(field, part)]
        found = inner or found  # a tag of an alternative, which the schema does not name
    return found


@lru_cache(maxsize=8)
def _schema(model: type[BaseModel]) -> Schema:
    return model.model_json_schema()


def _resolved(model: type[BaseModel], field: Schema) -> Schema:
    """A schema in place of a reference to it; the words beside the reference go with it."""
    if "$ref" not in field:
        return field
    own: Schema = _schema(model)["$defs"][field["$ref"].rsplit("/", 1)[-1]]
    return {**own, **{name: value for name, value in field.items() if name != "$ref"}}


def _unions(model: type[BaseModel], field: Schema) -> Iterator[Schema]:
    """A schema and the unions within it."""
    whole = _resolved(model, field)
    yield whole
    for each in (*whole.get("anyOf", ()), *whole.get("oneOf", ())):
        yield from _unions(model, each)


def _alternatives(model: type[BaseModel], field: Schema) -> Iterator[Schema]:
    """The kinds of value that a schema allows, except none."""
    return (
        each for each in _unions(model, field) if not {"anyOf", "oneOf"} & each.keys() and each.get("type") != "null"
    )


def _parts(field: Schema, part: int | str) -> Iterator[Schema]:
    """The schema of a field or an entry of an object or list."""
    if isinstance(part, int):
        entries = field.get("prefixItems", [])
        if part < len(entries):
            yield entries[part]
        elif isinstance(field.get("items"), dict):
            yield field["items"]
    elif part in field.get("properties", {}):
        yield field["properties"][part]
    elif isinstance(field.get("additionalProperties"), dict):
        yield field["additionalProperties"]


def words_of(model: type[BaseModel], field: Schema) -> list[str]:
    """The kinds of value that a schema allows, in words."""
    return [words for each in _alternatives(model, field) if (words := _words(model, each))]


def _words(model: type[BaseModel], field: Schema) -> str:
    """One kind of value in words."""
    if "const" in field or "enum" in field:
        return " or ".join(json.dumps(value) for value in field.get("enum", [field.get("const")]))
    match field.get("type"):
        case "number" | "integer":
            return _number(field)
        case "string":
            return 'text in quotes, as "a"'
        case "boolean":
            return "true or false"
        case "array" if "prefixItems" in field:
            kind, example = ("numbers", [0, 1]) if _of_numbers(field) else ("names", ["a", "b"])
            return f"a pair of {kind}, as {json.dumps(example)}"
        case "array":
            least = f"at least {field['minItems']} entries" if field.get("minItems", 0) > 1 else "entries"
            inner = words_of(model, field.get("items", {}))
            return f"a list of {least}" + (f", each {' or '.join(inner)}" if inner else "")
        case "object":
            needed = [f'"{name}"' for name in field.get("required", ())]
            return "an object" + (f" with {', '.join(needed)}" if needed else ", in braces")
    return ""


def _of_numbers(field: Schema) -> bool:
    return all(entry.get("type") == "number" for entry in field["prefixItems"])


def _number(field: Schema) -> str:
    """A number with its limits, and one within them."""
    kind = "a whole number" if field["type"] == "integer" else "a number"
    least, above = field.get("minimum", -LARGEST), field.get("exclusiveMinimum")
    most, below = field.get("maximum", LARGEST), field.get("exclusiveMaximum")
    limits = [f"above {above:g}"] if above is not None else [f"of at least {least:g}"] if least > -LARGEST else []
    if below is not None or most < LARGEST:
        limits.append(f"below {below:g}" if below is not None else f"of at most {most:g}")
    highest = most if below is None else 0.5 * below
    example = min(max(1, least, above or least), highest)
    return f"{' '.join([kind, ' and '.join(limits)]).strip()}, as {example:.15g}"


SCOPE = "docs/scope.md"
"""Where the scope of Drystone is written, from the root of the project."""
_OUTSIDE = {
    "joints that soften, or whose friction falls as they slide (cohesion and tensile_strength are fields)": (
        "mortar", "mortar_joint", "residual_friction", "peak_friction", "roughness", "fracture_energy",
    ),
    "blocks that crack or deform (joints crush by their compressive_strength)": (
        "strength", "crushing_strength", "crushing", "fc", "fk", "fm", "fd",
        "young", "youngs_modulus", "young_modulus", "elastic_modulus", "modulus", "poisson", "poisson_ratio",
        "shear_modulus", "stiffness", "normal_stiffness", "shear_stiffness", "kn", "ks", "creep",
    ),
    "prescribed displacements (settlements of supports are a field, for `drystone reaction`)": (
        "displacement", "displacements", "prescribed_displacement", "support_movement",
        "spread", "spreading", "rotation",
    ),
    "reinforcement and springs (ties and props are fields, of bars that yield)": (
        "tie_rod", "anchor", "anchors", "reinforcement", "rebar", "spring", "springs", "cable", "cables", "frp",
        "post_tension",
    ),
    "soil and water that resist (pressures and fills of a load are fields, and a dead fill may be passive)": (
        "passive", "passive_pressure", "passive_fill", "kp",
        "backfill", "fill", "soil", "earth", "earth_pressure", "foundation", "water", "pore_pressure", "uplift",
    ),
    "motion in time": (
        "damping", "mass", "time", "time_history", "accelerogram", "ground_motion", "velocity", "acceleration",
        "frequency", "restitution",
    ),
    "a third dimension": ("z", "depth", "polyhedron", "faces", "mesh", "out_of_plane"),
    "temperature": ("temperature", "thermal", "thermal_expansion"),
}  # fmt: skip
_WORDS = {word: model for model, words in _OUTSIDE.items() for word in words}


def outside_the_model(field: str) -> str:
    """The part of reality a field speaks of that Drystone does not model; empty for any other field."""
    word = re.sub(r"(?<=[a-z])(?=[A-Z])|[\s\-]+", "_", field).lower().strip("_")
    return _WORDS.get(word, "")
