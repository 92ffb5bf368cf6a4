#!/usr/bin/env python3
"""One part after the other, as the program of a line does it: line_loop.py RECIPE [HOST [PORT]], part ids on standard input."""

import json
import socket
import sys
import time

CONNECT_S, REPLY_S, RETRY_S, POLL_S = 3.0, 1.0, 0.5, 0.1
SEQ_CONFLICT, SEQ_STALE, UNKNOWN_JOB, INTERRUPTED, NO_CONTROL = 1009, 1010, 1007, 1014, 1003


class Line:
    def __init__(self, host, port, recipe=None):
        self.address, self.socket, self.id = (host, port), None, 0
        self.recipe = recipe  # by its name: the prepared one is that of whoever came last
        self.session, self.is_free = None, False  # is_free: the part was let go

    def ask(self, method, expected=(), **params):
        """The result, or an expected error. Without a reply in time: the same request again on a new connection."""
        is_told = False
        while True:
            self.id += 1
            try:
                if self.socket is None:
                    self.socket = socket.create_connection(self.address, CONNECT_S)
                    self.socket.settimeout(REPLY_S)
                request = {"jsonrpc": "2.0", "id": self.id, "method": method, "params": params}
                self.socket.sendall(json.dumps(request).encode() + b"\n")
                reply = json.loads(self.socket.makefile().readline())  # half a line is no JSON: ValueError
                if reply["id"] != self.id:
                    raise ValueError(reply)
            except (OSError, ValueError):
                if self.socket is not None:
                    self.socket.close()
                self.socket = None
                time.sleep(RETRY_S)
                continue
            if "result" in reply:
                return reply["result"]
            if reply["error"]["data"]["retry"]:  # 1001 not ready, 1002 busy, 1013 shutting down: it will be back
                if reply["error"]["code"] == NO_CONTROL and not is_told:
                    is_told = True  # people have to look where it lasts
                    print(reply["error"]["message"], file=sys.stderr, flush=True)
                time.sleep(POLL_S)
            elif reply["error"]["code"] in expected:
                return reply["error"]
            else:
                sys.exit(reply["error"]["message"])

    def begin(self):
        """The first number behind all that were used; what began before is of another session."""
        seq = self.ask("job.latest")["newest_seq"] + 1
        self.session = str(seq)
        return seq

    def let_go(self, part):
        self.is_free = True
        print(f"{part} may go", file=sys.stderr, flush=True)

    def measure(self, part, seq):
        """The part's result; seq: the number that it begins with."""
        self.is_free = False
        while not self.ask("system.state", format="compact")["ready"]:
            time.sleep(POLL_S)
        known = (SEQ_CONFLICT, SEQ_STALE, INTERRUPTED)
        started = self.ask("job.start", known, seq=seq, part_id=part, session=self.session,
                           recipe=self.recipe)
        if started.get("code") == SEQ_CONFLICT:
            return self.measure(part, self.begin())
        while True:  # also after 1010, 1014: the first request may have come through
            status = self.ask("job.status", () if self.is_free else (UNKNOWN_JOB,), seq=seq, format="compact")
            if status.get("code") == UNKNOWN_JOB:
                return self.measure(part, self.begin())
            if status["acquired"] and not self.is_free:
                self.let_go(part)
            if status["done"]:
                break
            time.sleep(POLL_S)
        result = self.ask("result.get", seq=seq)
        if (result["seq"], result["part_id"]) != (seq, part):
            sys.exit(f"asked for {seq} of {part}, got {result}")
        if result["error_code"] != INTERRUPTED:
            return result
        if self.is_free:
            sys.exit(f"{part} has left without a result: the daemon ended while it computed")
        self.ask("result.ack", seq=seq)
        return self.measure(part, seq + 1)  # the daemon ended meanwhile: the part is still there, once more

    def finish(self, part, seq):
        """To be called once the result is kept."""
        self.ask("result.ack", seq=seq)
        while not self.is_free:  # the stage was lost, or moving
            if self.ask("system.state", format="compact")["part_release"]:
                self.let_go(part)
            else:
                time.sleep(POLL_S)


def run(recipe, host="127.0.0.1", port=7411):
    line = Line(host, int(port), recipe)
    seq = line.begin()
    for part in map(str.strip, sys.stdin):
        result = line.measure(part, seq)
        print(json.dumps(result), flush=True)  # kept before it is acknowledged
        line.finish(part, result["seq"])
        seq = result["seq"] + 1


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 4:
        sys.exit(__doc__)
    run(*sys.argv[1:])
