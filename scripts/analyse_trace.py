#!/usr/bin/python3
"""Shows what a policy gets wrong, from the trace of an evaluation.

Example: early_fusion evaluate --policy models/simple.safetensors --task simple --trace trace.json
         scripts/analyse_trace.py trace.json
Prints tables in Markdown: the policy's actions against the expert's labels; the share of requested objects that were
collected, by item, by the expert's steps at the start and by exposure; the objects that were collected by mistake; and
the F1 that each cause costs.
"""
import argparse
import collections
import json
import sys

ACTIONS = ["PAN_LEFT", "PAN_RIGHT", "TILT_UP", "TILT_DOWN", "COLLECT", "REMOVE", "IDLE"]
LAST = 8  # the last steps, from which the cause of an ending is determined
NEAR = 3  # a requested object is beside the collected one if collecting it costs at most this many steps
SHOWN = 8  # episode numbers that are listed for each cause


def read_episodes(path):
    episodes = collections.defaultdict(list)
    number = 1
    try:
        with open(path) as file:
            for number, line in enumerate(file, 1):
                step = json.loads(line)
                episodes[step["episode"]].append(step)
    except OSError as error:
        sys.exit(f"analyse_trace.py: {path}: {error.strerror}")
    except (ValueError, KeyError, TypeError):
        sys.exit(f"analyse_trace.py: {path}:{number}: not a line of a trace (docs/trace.md)")
    if not episodes:
        sys.exit(f"analyse_trace.py: {path}: holds no steps (docs/trace.md)")
    return list(episodes.values())


def table(title, header, rows):
    print(f"\n**{title}**\n\n| {' | '.join(header)} |\n|{' --- |' * len(header)}")
    for row in rows:
        print(f"| {' | '.join(map(str, row))} |")


def share(part, whole):
    return f"{100 * part / whole:.0f}%" if whole else "-"


def confusion(episodes):
    counts = collections.Counter((step["expert_action"], step["action"]) for steps in episodes for step in steps)
    rows = []
    for expert in ACTIONS:
        total = sum(counts[expert, action] for action in ACTIONS)
        rows.append([expert, total] + [share(counts[expert, action], total) for action in ACTIONS])
    table("The policy's actions (columns) by the expert's label (rows)", ["expert", "steps"] + ACTIONS, rows)


def taken(step):
    """The item that COLLECT takes at a step; None if it takes nothing."""
    if step["action"] != "COLLECT" or not step["in_cone"]:
        return None
    return next(entry["item"] for entry in step["scene"] if entry["instance"] == step["in_cone"][0])


def collects(steps):
    """The steps at which COLLECT takes an object, with the object's item."""
    return [(step, taken(step)) for step in steps if taken(step) is not None]


def way(step, none):
    """The expert's steps to the nearest requested object; `none` if none can be reached."""
    return min((cost["steps"] for cost in step["expert_costs"]), default=none)


def distance(steps):
    """The expert's steps from the start to the nearest requested object, in tens."""
    nearest = way(steps[0], 0)
    low = 10 * (nearest // 10)
    return f"{low} to {low + 9} steps"


def exposure(steps, item):
    """The exposure of an item's best exposed instance at the start."""
    best = max(entry["exposure"] for entry in steps[0]["scene"] if entry["item"] == item)
    if best in (0, 1):
        return "none" if best == 0 else "all"
    return "under half" if best < 0.5 else "half or more"


def collected_by(title, key, episodes):
    """Prints a table of groups of requested items. key(steps, item) is the name of an item's group."""
    requested, collected = collections.Counter(), collections.Counter()
    for steps in episodes:
        for item in steps[0]["request"]:
            requested[key(steps, item)] += 1
        for step, item in collects(steps):
            if item in step["request"]:
                collected[key(steps, item)] += 1
    table(title, ["", "requested", "collected"],
          [[group, requested[group], share(collected[group], requested[group])] for group in sorted(requested)])


def mistakes(episodes):
    wrong = collections.Counter()
    for steps in episodes:
        for step, item in collects(steps):
            if item not in step["request"]:
                wrong[item, ", ".join(step["request"]) or "nothing"] += 1
    table("Collected by mistake", ["collected", "requested", "times"],
          [[item, request, count] for (item, request), count in wrong.most_common(10)])


def f1_score(steps):
    right = sum(item in step["request"] for step, item in collects(steps))
    return 2 * right / (len(collects(steps)) + len(steps[0]["request"]))


def mistake(step):
    """The cause of a COLLECT that took an unrequested object."""
    if not step["request"]:
        return "collected an object after the request was finished"
    instances = {entry["instance"]: entry["item"] for entry in step["scene"]}
    if any(instances[instance] in step["request"] for instance in step["in_cone"]):
        return "collected an object that is in front of a requested one in the cone"
    if way(step, float("inf")) <= NEAR:
        return f"collected an object that is beside a requested one, at most {NEAR - 1} moves from it"
    return "collected another object"


def ending(steps):
    """The cause of a requested object that is left at the end."""
    last = steps[-LAST:]
    places = {(step["pan_deg"], step["tilt_deg"]) for step in last}
    if way(steps[0], 0) > len(steps):
        return "out of reach: the expert also needs more steps than the episode has"
    if not any(entry["exposure"] for entry in last[-1]["scene"] if entry["item"] in last[-1]["request"]):
        return "not collected: fully occluded, only REMOVE gives access to it"
    if len(places) == 1:
        return f"not collected: repeated {' and '.join(sorted({step['action'] for step in last}))} without effect"
    return "not collected: panned back and forth" if len(places) <= 3 else "not collected: still moving at the end"


def faults(steps):
    """The causes of an F1 below 1: one for each mistake and one for each requested object that was not collected."""
    wrong = [mistake(step) for step, item in collects(steps) if item not in step["request"]]
    right = len(collects(steps)) - len(wrong)
    left = len(steps[-1]["request"]) - (taken(steps[-1]) in steps[-1]["request"])
    return wrong + ["removed a requested object"] * (len(steps[0]["request"]) - right - left) + [ending(steps)] * left


def losses(episodes):
    lost, counts, which = collections.Counter(), collections.Counter(), collections.defaultdict(list)
    for steps in episodes:
        causes = faults(steps)
        for cause in causes:
            counts[cause] += 1
            lost[cause] += (1 - f1_score(steps)) / len(causes) / len(episodes)
            which[cause].append(steps[0]["episode"])
    mean = sum(f1_score(steps) for steps in episodes) / len(episodes)
    table(f"Causes of the lost F1 (F1 is {mean:.3f}; an episode's loss is divided equally between its causes)",
          ["cause", "F1 lost", "times", "episodes"],
          [[cause, f"{loss:.4f}", counts[cause],
            ", ".join(map(str, which[cause][:SHOWN])) + (", ..." if len(which[cause]) > SHOWN else "")]
           for cause, loss in lost.most_common()])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("trace", help="the file that `early_fusion evaluate --trace` wrote")
    episodes = read_episodes(parser.parse_args().trace)
    confusion(episodes)
    collected_by("Collected, by item", lambda steps, item: item, episodes)
    collected_by("Collected, by the expert's steps from the start to the nearest requested object",
                 lambda steps, item: distance(steps), episodes)
    collected_by("Collected, by exposure at the start", exposure, episodes)
    mistakes(episodes)
    losses(episodes)


if __name__ == "__main__":
    main()
