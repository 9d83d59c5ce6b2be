"""The types of idl/ are those of ROS 2: their hashes (RIHS01, REP 2016) are the ones in messages.hpp.

These come from ROS 2 itself. A member that is missing, or has another name or type, gives another hash.
"""

import hashlib
import json
import re
import sys
from pathlib import Path

FOLDER = Path(__file__).parent.parent
IDS = {"int8": 2, "octet": 3, "short": 4, "unsigned short": 5, "long": 6, "unsigned long": 7,
       "float": 10, "double": 11, "boolean": 15, "string": 17}  # fmt: skip
BYTE, ARRAY, SEQUENCE = 16, 48, 144  # the last two are added to an id
BYTES = {("diagnostic_msgs/msg/DiagnosticStatus", "level")}  # `byte` there, and not uint8
MODULES = re.compile(r"module (\w+) \{ module (\w+) \{ module dds_ \{(.*?)\n\}; \}; \};", re.S)
STRUCTS = re.compile(r"struct (\w+)_ \{(.*?)\};", re.S)
MEMBERS = re.compile(r"^\s*(sequence<)?([\w: ]+?)>? (\w+)(?:\[(\d+)\])?;", re.M)

types = {}
for path in FOLDER.glob("idl/*.idl"):
    for package, kind, body in MODULES.findall(re.sub(r"//.*", "", path.read_text())):
        for name, members in STRUCTS.findall(body):
            types[f"{package}/{kind}/{name}"] = MEMBERS.findall(members)


def description(name: str, used: set[str]) -> dict[str, object]:
    fields = []
    for sequence, of, member, count in types[name]:
        number = BYTE if (name, member) in BYTES else IDS.get(of, 1)
        nested = ""
        if of not in IDS:
            nested = of.replace("::dds_", "").replace("::", "/").removesuffix("_")
            nested = nested if "/" in nested else f"{name.rpartition('/')[0]}/{nested}"
            used.add(nested)
        number += SEQUENCE if sequence else ARRAY if count else 0
        of_type = {"type_id": number, "capacity": int(count or 0), "string_capacity": 0, "nested_type_name": nested}
        fields.append({"name": member, "type": of_type})
    return {"type_name": name, "fields": fields}


def hash_of(name: str) -> str:
    used: set[str] = set()
    whole = description(name, used)
    done: dict[str, object] = {}
    while rest := used - done.keys():
        for each in rest:
            done[each] = description(each, used)
    text = {"type_description": whole, "referenced_type_descriptions": [done[each] for each in sorted(done)]}
    return hashlib.sha256(json.dumps(text).encode()).hexdigest()


text = (FOLDER / "include/saphira/ros2/messages.hpp").read_text()
topics = re.findall(r'"(\w+)::(\w+)::dds_::(\w+)_",\s*"([0-9a-f]{64})"', text)
wrong = [name for *of, known in topics if hash_of(name := "/".join(of)) != known]
print(f"{len(topics)} topics, {len(types)} types; with another hash: {wrong}")
sys.exit(1 if wrong or not topics else 0)
