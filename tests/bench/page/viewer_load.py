#!/usr/bin/env python3
"""Viewers as their pages are: a stream of events, the live picture again and again, the map of each result. Some never
read what they asked for.

viewer_load.py HTTP_PORT READERS NEVER
Prints "there" when all have what they asked for first, ends when its input ends, and prints one JSON object then.
"""

import json
import os
import select
import socket
import struct
import sys
import threading
import time

from event_stream import EventStream
from http_calls import Http

SMALLEST_BUFFER = 2048  # bytes; the kernel makes its least of it


def jpeg_width(data):
    """Of the first frame header; 0 where there is none."""
    at = 2
    while at + 9 < len(data) and data[at] == 0xFF:
        marker, length = data[at + 1], struct.unpack(">H", data[at + 2:at + 4])[0]
        if 0xC0 <= marker <= 0xC2:
            return struct.unpack(">H", data[at + 7:at + 9])[0]
        at += 2 + length
    return 0


class Reader:
    def __init__(self, port):
        self.port, self.is_over = port, False
        self.pictures, self.first_s, self.last_s, self.widest_px, self.bytes = 0, 0.0, 0.0, 0, 0
        self.events = self.maps = 0
        self.failure = ""
        self.stream = EventStream(port)
        if self.stream.status != 200 or self.stream.next().name != "snapshot":
            sys.exit("a viewer gets no events")
        self.threads = [threading.Thread(target=each, daemon=True) for each in (self.read_events, self.look_on)]
        for thread in self.threads:
            thread.start()

    def read_events(self):
        http = Http(self.port)
        while (event := self.stream.next()) is not None and not self.is_over:
            self.events += 1
            if event.name == "result":
                status, _, body = http.get(f"/api/v1/jobs/{event.data['job_id']}/height?max=512&kind=height")
                if status != 200 or body[:4] != b"FVDH":
                    self.failure = f"a viewer gets no map: {status} {body[:200]!r}"
                    return
                self.maps += 1

    def look_on(self):
        http, after, newest = Http(self.port), 0, 0
        while not self.is_over:
            status, fields, body = http.get(f"/api/v1/preview.jpg?after={after}")
            now = time.monotonic()
            if status == 204:
                after = 0  # as the page does: the picture that is there comes once more
                continue
            if status != 200:
                self.failure = f"a viewer gets no picture: {status} {body[:200]!r}"
                return
            after = int(fields["x-fvd-seq"])
            self.bytes += len(body)
            if after == newest:
                continue
            newest = after
            self.pictures += 1
            if self.pictures == 2:  # the first one may be of a scan before
                self.first_s = now
            self.last_s = now
            self.widest_px = max(self.widest_px, jpeg_width(body))

    def end(self):
        self.is_over = True
        self.stream.close()
        for thread in self.threads:
            thread.join(8)

    def pictures_per_s(self):
        return (self.pictures - 2) / (self.last_s - self.first_s) if self.pictures > 2 else 0.0


class NeverReader:
    """Asks again where the server gave it up."""

    PATHS = ("/api/v1/events", "/api/v1/preview.jpg?after=0")

    def __init__(self, port):
        self.port, self.asked = port, 0
        self.lines = {path: self.ask(path) for path in self.PATHS}

    def ask(self, path):
        line = socket.socket()
        line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, SMALLEST_BUFFER)
        line.connect(("127.0.0.1", self.port))
        line.sendall(f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\n\r\n".encode())
        self.asked += 1
        return line

    def ask_again(self):
        for path, line in self.lines.items():
            poll = select.poll()
            poll.register(line, select.POLLRDHUP | select.POLLHUP | select.POLLERR)
            if poll.poll(0):
                line.close()
                self.lines[path] = self.ask(path)


def main():
    port, readers, never = (int(word) for word in sys.argv[1:4])
    os.nice(10)  # they are on other machines: their work must not take the daemon's time
    reading = [Reader(port) for _ in range(readers)]
    silent = [NeverReader(port) for _ in range(never)]
    print("there", flush=True)
    while not select.select([sys.stdin], [], [], 0.2)[0]:
        for each in silent:
            each.ask_again()
    for reader in reading:
        reader.end()
    if failures := [reader.failure for reader in reading if reader.failure]:
        sys.exit("; ".join(failures))
    print(json.dumps({"pictures_per_s": min((reader.pictures_per_s() for reader in reading), default=0.0),
                      "pictures": sum(reader.pictures for reader in reading),
                      "widest_px": max((reader.widest_px for reader in reading), default=0),
                      "picture_bytes": sum(reader.bytes for reader in reading),
                      "events": sum(reader.events for reader in reading), "maps": sum(reader.maps for reader in reading),
                      "asked_and_not_read": sum(each.asked for each in silent)}), flush=True)
    os._exit(0)  # a long poll may still be under way  # pylint: disable=protected-access


main()
