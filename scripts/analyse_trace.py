#!/usr/bin/python3
"""Tells what a policy gets wrong, from the trace of an evaluation.

Example: early_fusion evaluate --policy models/simple.safetensors --task simple --trace trace.json
         scripts/analyse_trace.py trace.json
Prints, in Markdown: what the policy does where the expert would do what; how many requested objects were collected, by
type, by how far they were at the start, by how much stood before them; what was collected by mistake; and how the
episodes end in which something requested is left.
"""
import argparse
import collections
import json
import sys

ACTIONS = ["PAN_LEFT", "PAN_RIGHT", "TILT_UP", "TILT_DOWN", "COLLECT", "REMOVE", "IDLE"]
LAST = 8  # steps that an ending is told from


def read_episodes(path):
    episodes = collections.defaultdict(list)
    try:
        with open(path) as file:
            for number, line in enumerate(file, 1):
                step = json.loads(line)
                episodes[step["episode"]].append(step)
    except OSError as error:
        sys.exit(f"analyse_trace.py: {path}: {error.strerror}")
    except (ValueError, KeyError, TypeError):
        sys.exit(f"analyse_trace.py: {path}:{number}: not a line of a trace (docs/trace.md)")
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
    table("What the policy does (columns) where the expert would do what (rows)", ["expert", "steps"] + ACTIONS, rows)


def taken(step):
    """The item that COLLECT takes at a step; None when it takes nothing."""
    if step["action"] != "COLLECT" or not step["in_cone"]:
        return None
    return next(entry["item"] for entry in step["scene"] if entry["instance"] == step["in_cone"][0])


def distance(steps):
    """Steps from the start to the nearest requested object, by tens."""
    nearest = min((cost["steps"] for cost in steps[0]["expert_costs"]), default=0)
    low = 10 * (nearest // 10)
    return f"{low} to {low + 9} steps"


def exposure(steps, item):
    """How much of the way to an item's best exposed instance was free at the start."""
    best = max(entry["exposure"] for entry in steps[0]["scene"] if entry["item"] == item)
    if best in (0, 1):
        return "none" if best == 0 else "all"
    return "under half" if best < 0.5 else "half or more"


def collected_by(title, key, episodes):
    """key(steps, item) names the group that a requested item belongs to."""
    requested, collected = collections.Counter(), collections.Counter()
    for steps in episodes:
        for item in steps[0]["request"]:
            requested[key(steps, item)] += 1
        for step in steps:
            item = taken(step)
            if item in step["request"]:
                collected[key(steps, item)] += 1
    table(title, ["", "requested", "collected"],
          [[group, requested[group], share(collected[group], requested[group])] for group in sorted(requested)])


def mistakes(episodes):
    wrong = collections.Counter()
    for steps in episodes:
        for step in steps:
            item = taken(step)
            if item is not None and item not in step["request"]:
                wrong[item, ", ".join(step["request"]) or "nothing"] += 1
    table("Collected by mistake", ["collected", "requested", "times"],
          [[item, request, count] for (item, request), count in wrong.most_common(10)])


def ending(steps):
    last = steps[-LAST:]
    places = {(step["pan_deg"], step["tilt_deg"]) for step in last}
    actions = {step["action"] for step in last}
    if len(places) == 1:
        return f"the same in vain: {', '.join(sorted(actions))}"
    if len(places) <= 3:
        return "to and fro"
    return "under way"


def endings(episodes):
    failed = [steps for steps in episodes if steps[-1]["request"] and taken(steps[-1]) not in steps[-1]["request"]]
    groups = collections.defaultdict(list)
    for steps in failed:
        groups[ending(steps)].append(steps[0]["episode"])
    table(f"How the {len(failed)} of {len(episodes)} episodes end in which something requested is left",
          ["the last steps", "episodes", "which"],
          [[name, len(which), ", ".join(map(str, which[:8])) + (", ..." if len(which) > 8 else "")]
           for name, which in sorted(groups.items(), key=lambda group: -len(group[1]))])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("trace", help="what `early_fusion evaluate --trace` wrote")
    episodes = read_episodes(parser.parse_args().trace)
    confusion(episodes)
    collected_by("By type", lambda steps, item: item, episodes)
    collected_by("By the expert's way from the start to the nearest requested object",
                 lambda steps, item: distance(steps), episodes)
    collected_by("By the share of the orientations towards it at which nothing stood before it", exposure, episodes)
    mistakes(episodes)
    endings(episodes)


if __name__ == "__main__":
    main()
