"""The daemon's stream of events, as a client that is no browser reads it."""

import dataclasses
import http.client
import json
import socket
import threading
import time

PATIENCE_S = 60


@dataclasses.dataclass
class Event:
    id: str
    name: str
    text: str
    at_s: float  # CLOCK_MONOTONIC, when its last line was there

    @property
    def data(self):
        return json.loads(self.text) if self.text else None


class EventStream:
    """last_event_id: of the event before which everything is known."""

    def __init__(self, port, last_event_id=None):
        self.connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)
        fields = {"Accept": "text/event-stream"} | ({"Last-Event-ID": last_event_id} if last_event_id is not None else {})
        self.connection.request("GET", "/api/v1/events", headers=fields)
        self.socket = self.connection.sock
        self.reply = self.connection.getresponse()
        self.status = self.reply.status

    def next(self):
        """The next event, pings too; None at the end of the stream, also where close() ended it."""
        found = {"id": "", "event": "message", "data": []}
        try:
            while line := self.reply.readline():
                text = line.decode().rstrip("\r\n")
                if not text:
                    if found["data"] or found["event"] != "message":
                        return Event(found["id"], found["event"], "\n".join(found["data"]), time.monotonic())
                    continue
                name, _, value = text.partition(":")
                value = value.removeprefix(" ")
                if name == "data":
                    found["data"].append(value)
                elif name in found:
                    found[name] = value
        except (OSError, ValueError, http.client.HTTPException):
            pass
        return None

    def close(self):
        """Another thread may be reading: it comes to the end, and the reply stays open for it until then."""
        try:
            self.socket.shutdown(socket.SHUT_RDWR)
        except OSError:
            pass
        self.socket.close()


class Follower(threading.Thread):
    """Reads a stream to its end. `seen`: every event but pings, the newest last."""

    def __init__(self, port, last_event_id=None):
        super().__init__(daemon=True)
        self.stream = EventStream(port, last_event_id)
        self.seen = []
        self.changed = threading.Condition()
        self.start()

    def run(self):
        while (event := self.stream.next()) is not None:
            if event.name != "ping":
                with self.changed:
                    self.seen.append(event)
                    self.changed.notify_all()

    def find(self, fits, since=0, within_s=PATIENCE_S):
        """The first event from number `since` on that fits."""
        deadline = time.monotonic() + within_s
        with self.changed:
            at = since
            while True:
                while at < len(self.seen):
                    if fits(self.seen[at]):
                        return self.seen[at]
                    at += 1
                if not self.changed.wait(max(0.0, deadline - time.monotonic())):
                    raise TimeoutError(f"no such event among {len(self.seen) - since} of {within_s} s")

    def count(self):
        with self.changed:
            return len(self.seen)

    def close(self):
        self.stream.close()
        self.join(10)
