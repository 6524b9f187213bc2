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
    table("What the policy does (columns) where the expert would do what (rows)", ["expert", "steps"] + ACTIONS, rows)


def taken(step):
    """The item that COLLECT takes at a step; None when it takes nothing."""
    if step["action"] != "COLLECT" or not step["in_cone"]:
        return None
    return next(entry["item"] for entry in step["scene"] if entry["instance"] == step["in_cone"][0])


def collects(steps):
    """The steps at which COLLECT takes something, and what."""
    return [(step, taken(step)) for step in steps if taken(step) is not None]


def way(step, none):
    """Steps that collecting the nearest requested object costs; `none` where there is none to be reached."""
    return min((cost["steps"] for cost in step["expert_costs"]), default=none)


def distance(steps):
    """Steps from the start to the nearest requested object, by tens."""
    nearest = way(steps[0], 0)
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
    """What led to a COLLECT that took something not requested."""
    if not step["request"]:
        return "collected when nothing was requested any more"
    instances = {entry["instance"]: entry["item"] for entry in step["scene"]}
    if any(instances[instance] in step["request"] for instance in step["in_cone"]):
        return "collected what stands before a requested object in the cone"
    if way(step, float("inf")) <= NEAR:
        return f"collected what stands beside a requested object, {NEAR - 1} moves from it or less"
    return "collected something else"


def ending(steps):
    """Why something requested is left at the end."""
    last = steps[-LAST:]
    places = {(step["pan_deg"], step["tilt_deg"]) for step in last}
    if way(steps[0], 0) > len(steps):
        return "out of reach: the expert needs more steps than there are, too"
    if not any(entry["exposure"] for entry in last[-1]["scene"] if entry["item"] in last[-1]["request"]):
        return "not collected: nothing but REMOVE makes way to it"
    if len(places) == 1:
        return f"not collected: {' and '.join(sorted({step['action'] for step in last}))} in vain"
    return "not collected: to and fro" if len(places) <= 3 else "not collected: still under way when time was up"


def faults(steps):
    """Why an episode's F1 is less than 1: a cause for each mistake and for each requested object not collected."""
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
    table(f"What F1 {sum(f1_score(steps) for steps in episodes) / len(episodes):.3f} lacks of 1 (each episode's share "
          "divided equally among what went wrong in it)",
          ["cause", "F1 lost", "times", "episodes"],
          [[cause, f"{loss:.4f}", counts[cause],
            ", ".join(map(str, which[cause][:SHOWN])) + (", ..." if len(which[cause]) > SHOWN else "")]
           for cause, loss in lost.most_common()])


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
    losses(episodes)


if __name__ == "__main__":
    main()
