"""A program that does on order what programs do, good and bad: what `methods.toml` of these tests starts.

    program.py [--lines] WHAT WALL RESULT [...]

It is no part of Drystone: it reads the wall that it is given and writes a file.
"""

from __future__ import annotations

import json
import os
import signal
import sys
import time
from typing import Any

MEGABYTE = 2**20


def sliding(wall: dict[str, Any]) -> dict[str, Any]:
    """The sliding state of one block on its base, by hand: N = W shared so that moments vanish, s = -mu N."""
    arrays = wall["metadata"]["arrays"]
    mu, block = arrays["friction"][0], 1 - [bool(held) for held in arrays["fixed"]].index(True)
    weight = -arrays["dead"][block][1]
    (x1, y1), (x2, _), (cx, cy) = arrays["end1"][0], arrays["end2"][0], arrays["centroid"][block]
    side = 1.0 if arrays["block_b"][0] == block else -1.0
    at = cx + mu * (cy - y1)  # where the resultant of the weight and mu times the weight to the right meets the bed
    second = weight * (at - x1) / (x2 - x1)
    along = 1.0 if x2 > x1 else -1.0
    mechanism = [[0.0, 0.0, 0.0] for _ in arrays["fixed"]]
    mechanism[block] = [1.0, 0.0, 0.0]
    forces = [[weight - second, second, -side * along * mu * weight]]
    return {"format": "result/1", "multiplier": mu, "forces": forces, "mechanism": mechanism}


def act(what: str, wall: dict[str, Any], words: list[str]) -> Any:
    """The result, after what was ordered was done."""
    result = sliding(wall) if len(wall["interfaces"]) == 1 else {"format": "result/1", "status": "refused"}
    match what:
        case "exit":
            print("no licence found")
            sys.exit(3)
        case "abort":
            os.kill(os.getpid(), signal.SIGABRT)
        case "nothing":
            sys.exit(0)
        case "hang":
            time.sleep(3600)
        case "leave a child":
            if os.fork() == 0:
                time.sleep(3600)
        case "begin a session":
            if os.fork() == 0:
                os.setsid()
                if os.fork() == 0:
                    time.sleep(3600)
                os._exit(0)
        case "begin a session and hang":
            if os.fork() == 0:
                os.setsid()
                time.sleep(3600)
            time.sleep(3600)
        case "burn elsewhere":
            ours, theirs = os.pipe()
            if os.fork() == 0:
                os.setsid()
                act("burn", wall, words)
                os.write(theirs, b"burned")
                time.sleep(3600)
            os.read(ours, 6)
        case "eat and go":
            hoard = bytearray(400 * MEGABYTE)
            hoard[::4096] = b"x" * len(hoard[::4096])
        case "burn":
            until = time.process_time() + 0.5
            while time.process_time() < until:
                pass
        case "eat":
            hoard = bytearray(400 * MEGABYTE)
            hoard[::4096] = b"x" * len(hoard[::4096])
            time.sleep(0.2)
        case "eat on":
            more = []
            while True:
                more.append(bytearray(b"x") * (16 * MEGABYTE))
        case "multiplier":
            return {"format": "result/1", "multiplier": result["multiplier"]}
        case "wrong sign":
            result["forces"][0][2] *= -1.0
        case "nan":
            result["multiplier"] = float("nan")
        case "too few":
            result["forces"] = []
        case "typing mistake":
            result["mulitplier"] = result.pop("multiplier")
        case "text":
            return "collapses at .3"
        case "words":
            result["details"] = {"words": words, "pid": os.getpid()}
        case "not converged":
            return {"format": "result/1", "status": "not_converged", "sentence": "It went round in circles."}
        case "certificate" | "forged":
            with open(words[0], encoding="utf-8") as file:
                result |= {"certificate": json.load(file), "lower_bound": result["multiplier"]}
            if what == "forged":
                result["certificate"]["bound"] = "1000/1"
    return result


def main() -> None:
    """Answer once, or line by line."""
    if sys.argv[1] == "--lines":
        for line in sys.stdin:
            request = json.loads(line)
            what = request["settings"].get("does", "words")
            if what == "chatter":
                print("I am thinking")
            if what == "leave":
                sys.exit(0)
            told = json.dumps(act(what, request["wall"], sys.argv[2:]))
            if what == "latin":
                sys.stdout.buffer.write(told.encode().replace(b"format", b"f\xf6rmat") + b"\n")
                sys.stdout.flush()
                continue
            print("\n".join([told] * (2 if what == "twice" else 1)), flush=True)
        return
    what, wall, result, *words = sys.argv[1:]
    with open(wall, encoding="utf-8") as file:
        found = act(what, json.load(file), words)
    with open(result, "w", encoding="utf-8") as file:
        json.dump(found, file)


def describe(settings: dict[str, Any]) -> None:
    """Print a description, if that is asked for."""
    if "--describe" in sys.argv:
        about = {"format": "describe/1", "name": "lines", "version": "2.5", "licence": "MIT", "settings": settings}
        print(json.dumps(about | {"title": "by lines", "traits": {"caption": "by hand"}, "most_blocks": 5}))
        sys.exit(0)


if __name__ == "__main__":
    acts = ("words", "chatter", "leave", "twice", "exit", "hang", "burn", "typing mistake", "latin", "eat and go")
    describe({"does": {"type": "string", "default": "words", "enum": acts}})
    main()
