#!/usr/bin/python3
"""Disturbs training sessions over ROS for some minutes, and compares their weights with those of undisturbed ones.

    . devel/setup.sh; bench/soak.py --minutes 10 --output /tmp/soak

One session after the other is trained twice: by `early_fusion train`, and by train.launch. The launched one is
disturbed: every few seconds a random node is killed; hostile messages go to its topics; and a bag of its own first
messages is played in a loop, for some seconds at a time. The design promises that none of this changes a bit: the
weights and the scores of the episodes must be the same. If they differ, or if a session does not end, the exit code is
1, and the session's folders and logs stay. Which node dies when is a function of the seed; what it does then is not.
"""
import argparse
import json
import os
import random
import shutil
import signal
import socket
import struct
import subprocess
import sys
import threading
import time

import genpy
import rosgraph
import rospy
from early_fusion.msg import Action, Instance, Request, Scene, Weights

KILLED = ("policy", "simulator", "trainer")
STEPS = 8
IMAGE_SIZE = 32
SESSION_LIMIT_SEC = 900  # far more than a session takes
QUIET_SEC, BAG_SEC = 12, 3  # between two plays of the bag, and a play: a policy that sees the bag answers no episode


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=5, help="no session is begun after this time")
    parser.add_argument("--output", default="soak", help="a new folder")
    parser.add_argument("--seed", type=int, default=1, help="of the first session and of the disturbances")
    parser.add_argument("--trajectories", type=int, default=60, help="length of a session")
    parser.add_argument("--kill-every", type=float, default=4, metavar="SECONDS", help="mean time between two kills")
    parser.add_argument("--rate", type=float, default=20, help="maximum number of a simulator's steps a second")
    return parser.parse_args()


def program():
    for prefix in os.environ.get("CMAKE_PREFIX_PATH", "").split(":"):
        path = os.path.join(prefix, "lib", "early_fusion", "early_fusion")
        if os.path.exists(path):
            return path
    sys.exit("soak.py: early_fusion is not in CMAKE_PREFIX_PATH; source devel/setup.sh first")


def write_files(folder, trajectories):
    """Files of a world, a task and a preset so small that a session takes a minute."""
    share = os.environ.get("EARLY_FUSION_SHARE") or os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    texts = {
        "world.yaml": "{objects: %s/config/objects.yaml, kitchen_urdf: %s/urdf/kitchen.urdf, "
                      "camera_urdf: %s/urdf/pan_tilt_camera.urdf, image_size: %d}" % (share, share, share, IMAGE_SIZE),
        "task.yaml": "{instances: 3, requested: 2, steps: %d}" % STEPS,
        "preset.yaml": "{trajectories: %d, trajectories_per_round: 4, window: 12, epochs: 1, batch_size: 8, "
                       "learning_rate: 1e-3, image_size: %d, precision: f32}" % (trajectories, IMAGE_SIZE)}
    for name, text in texts.items():
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text + "\n")


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def stop(process, sec=15):
    if process.poll() is None:
        process.send_signal(signal.SIGINT)
    try:
        process.wait(sec)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


class Master:
    """A master of the soak's own, to which all processes that this script starts talk."""

    def __init__(self, folder):
        port = free_port()
        home = os.path.join(folder, "ros_home")
        os.environ.update(ROS_MASTER_URI="http://127.0.0.1:%d" % port, ROS_IP="127.0.0.1", PYTHONUNBUFFERED="1",
                          ROS_HOME=home, ROS_LOG_DIR=os.path.join(home, "log"))
        os.environ.pop("ROS_HOSTNAME", None)
        with open(os.path.join(folder, "roscore.log"), "wb") as log:
            self.process = subprocess.Popen(["roscore", "-p", str(port)], stdout=log, stderr=log)
        while not rosgraph.is_master_online():
            if self.process.poll() is not None:
                sys.exit("soak.py: roscore has ended; see %s/roscore.log" % folder)
            time.sleep(0.1)

    def nodes(self, name):
        """The process ids of a node, one for each worker."""
        log_folder = os.environ["ROS_LOG_DIR"]
        found = []
        for pid in filter(str.isdigit, os.listdir("/proc")):
            try:
                with open("/proc/%s/cmdline" % pid, "rb") as file:
                    words = file.read().decode(errors="replace").split("\0")
            except OSError:
                continue
            if words[0].endswith("/%s_node" % name) and any(w.startswith("__log:=" + log_folder) for w in words):
                found.append(int(pid))
        return sorted(found)


class Raw(genpy.Message):
    """A message of given bytes, which may be none of its type. Debian's python3-sensor-msgs is not needed."""
    __slots__ = ["content"]
    _full_text, _slot_types = "", ["uint8[]"]

    def __init__(self, content=b""):
        super().__init__()
        self.content = content

    def serialize(self, buff):
        buff.write(self.content)


class RawImage(Raw):
    _type, _md5sum = "sensor_msgs/Image", "060021388200f6f0f447d0fcd9c64743"


class RawCameraInfo(Raw):
    _type, _md5sum = "sensor_msgs/CameraInfo", "c9a58c1b0b154e0e6da7578cb991d214"


def header_bytes():
    now = rospy.Time.now()
    return struct.pack("<4I", 0, now.secs, now.nsecs, 0)


def image_bytes(draw, odd):
    encoding = draw.choice(["rgb8", "rgb16", "bayer_rggb16", "yuv422", odd]).encode()
    size = [draw.choice([0, 1, IMAGE_SIZE, 60000]) for _ in range(2)]
    data = bytes(draw.choice([0, 17, 3 * IMAGE_SIZE**2]))
    step = draw.choice([0, 3 * IMAGE_SIZE, 2**32 - 1])
    return (header_bytes() + struct.pack("<3I", *size, len(encoding)) + encoding +
            struct.pack("<BII", draw.randrange(2), step, len(data)) + data)


def camera_info_bytes(draw, number):
    sizes = [draw.choice([0, 1, IMAGE_SIZE, 2**32 - 1]) for _ in range(8)]
    return (header_bytes() + struct.pack("<4I", *sizes[:2], 0, 0) + struct.pack("<30d", *[number] * 30) +
            struct.pack("<6IB", *sizes[2:], 0))


def hostile_messages(draw):
    """(topic, message): each is wrong in another way."""
    odd = draw.choice(["", "hammer", "x" * 50000, "\n\0\x1b[31m", "../../etc/shadow"])
    number = draw.choice([float("nan"), float("inf"), -1e308, 0])
    image, info = RawImage(image_bytes(draw, odd)), RawCameraInfo(camera_info_bytes(draw, number))
    cut = RawImage(image.content[:draw.randrange(len(image.content))])
    request = Request(episode=draw.choice([0, 2**64 - 1]), step=draw.choice([0, 2**32 - 1]),
                      items=[odd] * draw.randrange(9))
    instance = Instance(item=odd, x=number, y=number, theta=number, present=True)
    scene = Scene(task=odd, seed=2**64 - 1, steps=draw.choice([0, 2**32 - 1]), pan=draw.choice([0, 2**31 - 1]),
                  tilt=-2**31, instances=[instance] * draw.choice([0, 1, 40]), request=[odd], previous_action=odd)
    action = Action(name=odd, weights=odd, mode=odd, frames=255, probabilities=[number] * draw.randrange(9))
    header = draw.choice([b"", b"{", b'{"t":{"dtype":"F32","shape":' + b"[" * 100000, b"\xff" * 100])
    weights = Weights(id=odd, mode=odd, precision=odd, data=len(header).to_bytes(8, "little") + header)
    request.header.stamp = scene.header.stamp = action.header.stamp = rospy.Time.now()
    return [("camera/image_raw", image), ("camera/image_raw", cut), ("camera/camera_info", info), ("request", request),
            ("scene", scene), ("action", action), ("weights", weights)]


class Disturbance:
    """Kills nodes, sends hostile messages and plays a bag, until stop()."""

    def __init__(self, master, folder, seed, kill_every_sec):
        self.master, self.folder, self.kill_every_sec = master, folder, kill_every_sec
        self.kills = {name: 0 for name in KILLED}
        self.messages = self.plays = 0
        self.stopped = threading.Event()
        self.publishers = {}
        works = [(self.kill, seed), (self.send, seed + 1), (self.play, seed + 2)]
        self.threads = [threading.Thread(target=work, args=(random.Random(s),), daemon=True) for work, s in works]
        for thread in self.threads:
            thread.start()

    def stop(self):
        self.stopped.set()
        for thread in self.threads:
            thread.join()
        for publisher in self.publishers.values():
            publisher.unregister()

    def kill(self, draw):
        while not self.stopped.wait(draw.uniform(0.5, 1.5) * self.kill_every_sec):
            name = draw.choice(KILLED)
            place = draw.random()
            victims = self.master.nodes(name)
            if not victims:
                continue  # it is about to be started again
            try:
                os.kill(victims[int(place * len(victims))], signal.SIGKILL)
                self.kills[name] += 1
            except ProcessLookupError:
                pass

    def send(self, draw):
        while not self.stopped.wait(0.5):
            topic, message = draw.choice(hostile_messages(draw))
            if topic not in self.publishers:
                self.publishers[topic] = rospy.Publisher(topic, type(message), queue_size=2)
            self.publishers[topic].publish(message)
            self.messages += 1

    def play(self, _):
        bag = os.path.join(self.folder, "first.bag")
        topics = ["camera/image_raw", "camera/camera_info", "request", "scene", "action"]
        with open(os.path.join(self.folder, "bag.log"), "wb") as log:
            def run(command, sec):
                process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log)
                self.stopped.wait(sec)
                stop(process)

            run(["rosbag", "record", "-O", bag] + topics, BAG_SEC + 3)
            while not self.stopped.wait(QUIET_SEC) and os.path.exists(bag):
                run(["rosbag", "play", "--loop", "--quiet", bag], BAG_SEC)
                self.plays += 1


def trained_undisturbed(given, output, log):
    words = [word for name, value in given for word in ("--" + name.replace("_", "-"), str(value))]
    subprocess.run([program(), "train"] + words + ["--output", output], check=True, stdout=log, stderr=log)


def result_of(folder):
    with open(os.path.join(folder, "weights.safetensors"), "rb") as file:
        weights = file.read()
    with open(os.path.join(folder, "result.json"), encoding="utf-8") as file:
        return weights, json.load(file)["per_episode"]


def seen(folder, trajectories):
    """The share of the session that is saved."""
    try:
        with open(os.path.join(folder, "curve.csv"), encoding="utf-8") as file:
            return int(file.read().strip().rsplit("\n", 1)[-1].split(",")[1]) / trajectories
    except (OSError, IndexError, ValueError):
        return 0


class Soak:
    def __init__(self, arguments):
        self.arguments = arguments
        self.began = time.monotonic()
        self.kills = {name: 0 for name in KILLED}
        self.messages = self.plays = self.sessions = 0
        self.folder = os.path.abspath(arguments.output)
        os.makedirs(self.folder)
        write_files(self.folder, arguments.trajectories)
        self.master = Master(self.folder)
        rospy.init_node("soak", disable_signals=True)

    def left_sec(self):
        return 60 * self.arguments.minutes - (time.monotonic() - self.began)

    def report(self, share):
        left = max(0, self.left_sec())
        spent = time.monotonic() - self.began
        print("%4d s, session %d: %3.0f %%, %d kills; %d:%02d min and the rest of a session left" % (
            spent, self.sessions + 1, 100 * share, sum(self.kills.values()), left // 60, left % 60), flush=True)

    def launched(self, given, output):
        """Whether train.launch has trained the session, which is disturbed, to its end."""
        words = ["%s:=%s" % pair for pair in given] + ["output:=" + output]
        words += ["rate:=%g" % self.arguments.rate, "respawn_delay:=0.2", "stall_timeout:=2", "tf:=false"]
        words.append("separate:=true")  # so that each of them can die alone
        with open(output + ".log", "wb") as log:
            session = subprocess.Popen(["roslaunch", "early_fusion", "train.launch"] + words, stdout=log, stderr=log)
        disturbance = Disturbance(self.master, self.folder, 3 * dict(given)["seed"], self.arguments.kill_every)
        before, end = dict(self.kills), time.monotonic() + SESSION_LIMIT_SEC
        while session.poll() is None and time.monotonic() < end:
            time.sleep(0.5)
            if time.monotonic() > getattr(self, "next_report", 0):
                self.kills = {name: before[name] + disturbance.kills[name] for name in KILLED}
                self.report(seen(output, self.arguments.trajectories))
                self.next_report = time.monotonic() + 10
        disturbance.stop()
        self.kills = {name: before[name] + disturbance.kills[name] for name in KILLED}
        self.messages += disturbance.messages
        self.plays += disturbance.plays
        stop(session)
        return os.path.exists(os.path.join(output, "result.json"))

    def fault(self):
        """Trains a session in both ways. @return what is wrong, or None."""
        number = self.arguments.seed + self.sessions
        files = {name: os.path.join(self.folder, name + ".yaml") for name in ("world", "task", "preset")}
        given = [*files.items(), ("seed", number), ("evaluation_episodes", 3)]
        reference, output = (os.path.join(self.folder, "%s%d" % (n, number)) for n in ("undisturbed", "disturbed"))
        with open(reference + ".log", "wb") as log:
            trained_undisturbed(given, reference, log)
        if not self.launched(given, output):
            return "the session has not come to its end; see %s.log" % output
        for what, one, other in zip(("weights", "scores of the episodes"), result_of(reference), result_of(output)):
            if one != other:
                return "the %s of %s differ from those of %s" % (what, output, reference)
        shutil.rmtree(reference)
        shutil.rmtree(output)
        return None

    def run(self):
        try:
            fault = None
            while fault is None and (self.left_sec() > 0 or self.sessions == 0):
                fault = self.fault()
                self.sessions += fault is None
        finally:
            stop(self.master.process)
        kills = ", ".join("%d of %s_node" % (count, name) for name, count in self.kills.items())
        minutes = (time.monotonic() - self.began) / 60
        print("%d sessions of %d trajectories with the same weights and scores in %.1f min; killed: %s; %d hostile "
              "messages; the bag was played %d times" % (self.sessions, self.arguments.trajectories, minutes, kills,
                                                         self.messages, self.plays))
        if fault is not None:
            print("soak.py: session %d: %s" % (self.sessions + 1, fault), file=sys.stderr)
        return 1 if fault else 0


if __name__ == "__main__":
    sys.exit(Soak(parse_arguments()).run())
