#!/usr/bin/env python3
"""One part after the other, as the program of a line does it: line_loop.py [HOST [PORT]], part ids on standard input."""

import json
import socket
import sys
import time

CONNECT_S, REPLY_S, RETRY_S, POLL_S = 3.0, 1.0, 0.5, 0.1
SPENT = {1009, 1010, 1014}  # seq_conflict, seq_stale, interrupted: the part needs another number


class Line:
    def __init__(self, host, port):
        self.address, self.socket, self.id = (host, port), None, 0

    def ask(self, method, **params):
        """The result, or the error. Without a reply in time: the same request again on a new connection."""
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
            if reply["error"]["data"]["retry"]:
                time.sleep(POLL_S)  # 1001 not ready, 1002 busy, 1013 shutting down: it will be back
            elif reply["error"]["code"] in SPENT:
                return {"error_code": reply["error"]["code"]}
            else:
                sys.exit(reply["error"]["message"])

    def measure(self, part, seq):
        """The part's result; seq: the number that it begins with."""
        while not self.ask("system.state", format="compact")["ready"]:
            time.sleep(POLL_S)
        while self.ask("job.start", seq=seq, part_id=part).get("error_code") in SPENT:
            seq = self.ask("job.latest")["newest_seq"] + 1
        while not self.ask("job.status", seq=seq, format="compact")["done"]:
            time.sleep(POLL_S)  # the part may go as soon as `acquired` is true
        result = self.ask("result.get", seq=seq)
        if (result["seq"], result["part_id"]) != (seq, part):
            sys.exit(f"asked for {seq} of {part}, got {result}")
        if result["error_code"] not in SPENT:
            return result
        self.ask("result.ack", seq=seq)  # the daemon ended meanwhile: the part once more
        return self.measure(part, seq + 1)


def run(host="127.0.0.1", port=7411):
    line = Line(host, int(port))
    seq = line.ask("job.latest")["newest_seq"] + 1
    for part in map(str.strip, sys.stdin):
        result = line.measure(part, seq)
        print(json.dumps(result), flush=True)  # kept before it is acknowledged
        line.ask("result.ack", seq=result["seq"])
        seq = result["seq"] + 1


if __name__ == "__main__":
    run(*sys.argv[1:])
