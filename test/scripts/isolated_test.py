"""Runs a master and a node in scripts/isolated.sh: what listens where, and who reaches it."""
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

ROOT, SIMULATOR = sys.argv.pop(1), sys.argv.pop(1)
SCRIPT = os.path.join(ROOT, "scripts", "isolated.sh")
LISTEN = "0A"  # the state's code in /proc/net/tcp
LOOPBACK = "0100007F"  # 127.0.0.1 there


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def connects(port):
    with socket.socket() as client:
        client.settimeout(5)
        return client.connect_ex(("127.0.0.1", port)) == 0


def listeners(pid):
    """{(address in hex, port)} of the sockets that listen in the process's network namespace."""
    with open(f"/proc/{pid}/net/tcp") as table:
        rows = [line.split() for line in table][1:]
    return {(row[1].split(":")[0], int(row[1].split(":")[1], 16)) for row in rows if row[3] == LISTEN}


class Isolated(unittest.TestCase):
    def start(self, *command):
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                   env=self.environment, start_new_session=True)
        self.addCleanup(process.wait)
        self.addCleanup(os.killpg, process.pid, signal.SIGTERM)
        return process

    def inside(self, pid, *command):
        """What a command that is started in the namespaces of the process prints."""
        enter = ["nsenter", "--preserve-credentials", "--user", "--net", "--target", str(pid)]
        return subprocess.run([*enter, *command], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                              env=self.environment).stdout.decode()

    def wait_for(self, what):
        for _ in range(100):
            if what():
                return
            time.sleep(0.1)
        self.fail("not after a hundred tries")

    def test_a_node_is_reached_from_inside_only(self):
        port = free_port()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.environment = {**os.environ, "ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_LOG_DIR": folder.name,
                            "ROS_HOME": folder.name}
        node = f"roscore -p {port} & until rostopic list; do sleep 0.2; done; exec {SIMULATOR} _task:=simple"
        shell = self.start(SCRIPT, "bash", "-c", node).pid
        self.wait_for(lambda: "/simulator" in self.inside(shell, "rosnode", "list"))

        self.assertFalse(connects(port), "the master is reached from outside")
        open_to_all = {port for address, port in listeners(shell) if address != LOOPBACK}
        # docs/ros.md: roscpp's XMLRPC servers, of rosout and the simulator, are all that a firewall has to close.
        self.assertEqual(len(open_to_all), 2)
        uri = self.inside(shell, "rosnode", "info", "/simulator")
        self.assertTrue(any(f":{port}/" in uri for port in open_to_all), uri)
        for port in open_to_all:
            self.assertFalse(connects(port))

    def test_the_command_keeps_its_exit_status(self):
        self.assertEqual(subprocess.run([SCRIPT, "sh", "-c", "exit 7"]).returncode, 7)

    def test_no_command_is_an_error(self):
        self.assertEqual(subprocess.run([SCRIPT], stdout=subprocess.DEVNULL).returncode, 1)


if __name__ == "__main__":
    try:
        allowed = subprocess.run([SCRIPT, "true"]).returncode == 0
    except OSError:
        allowed = False
    if not allowed:
        print("skipped: this machine does not let users make network namespaces (unshare, ip)")
        sys.exit(77)
    unittest.main()
