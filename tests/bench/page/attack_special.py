"""Attacks that are more than one request: each returns whether it was refused, or the reply that tells."""

import json
import socket

from attack_site import JSON_TYPE
from event_stream import EventStream
from http_calls import Http, send_raw
from rig import Answer

LONGEST_S = 14  # 10 s are allowed for a header and for a body
SOON_S = 1.0    # for who has a token, on a busy machine


def say(what, outcome):
    if not outcome:
        print(f"not refused: {what}", flush=True)
    return bool(outcome)


def a_guess(site):
    """Each wrong token is answered later than the one before, and all of them after a right one."""
    times_s = []
    for i in range(4):
        reply = site.start(token=f"{i:064}")
        times_s.append(reply.seconds)
        if reply.status != 401:
            return say(f"{reply}", False)
    return say(f"guesses are answered after {times_s} s",
               all(later > 1.5 * sooner for sooner, later in zip(times_s, times_s[1:])) and site.known_caller() < SOON_S)


def deep_brackets(site):
    return site.raw("POST", "/api/jsonrpc", JSON_TYPE, body=b"[" * 60000)


def a_slow_header(site):
    head = b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n" + b"X-Slow: 0123456789\r\n" * 100
    reply = send_raw(site.port, head, within_s=30, pieces_s=0.2)
    return say(f"{reply}", reply.status in (None, 408) and reply.seconds < LONGEST_S and site.known_caller() < SOON_S)


def a_slow_body(site):
    reply = site.raw("POST", "/api/jsonrpc", JSON_TYPE, "Content-Length: 1000", body=b"{", within_s=30)
    return say(f"{reply}", reply.status in (None, 408) and reply.seconds < LONGEST_S)


def a_flood(site):
    silent = [socket.create_connection(("127.0.0.1", site.port), timeout=5) for _ in range(100)]
    try:
        took_s = site.known_caller()
    finally:
        for line in silent:
            line.close()
    return say(f"beside a hundred silent connections a call takes {took_s:.2f} s", took_s < SOON_S)


def a_ninth_stream(site):
    streams = [EventStream(site.port) for _ in range(8)]
    try:
        statuses = [stream.status for stream in streams]
        ninth = EventStream(site.port)
        statuses.append(ninth.status)
        ninth.close()
    finally:
        for stream in streams:
            stream.close()
    return say(f"nine streams are answered with {statuses}", statuses == [200] * 8 + [503])


def a_log_line(site):
    """Texts of callers that would begin a line of their own in the log."""
    forged = "[2026-01-01 00:00:00.000] [critical] FORGED"
    line = f"x\n{forged}"
    operator = Http(site.port, site.rig.tokens["operate"])
    start = {"seq": 901, "part_id": "p", "recipe": "part"}
    asked = (*(("job.start", start | {key: line}) for key in ("part_id", "recipe", "client")),
             ("control.acquire", {"owner": line}), (line, {}))
    taken = []
    for method, params in asked:
        try:
            operator.call(method, **params)
            taken.append(f"{method} {params}")
        except Answer:
            pass
    operator.close()
    site.raw("GET", "/x%0a" + forged.replace(" ", "%20"))
    site.raw("GET", "/", f"User-Agent: a\r\n {forged}")
    begins = [each for each in site.rig.log().splitlines() if each.startswith(forged[:12])]
    return say(f"taken: {taken}; lines of the log: {begins}", not taken and not begins)


def a_smuggled_request(site):
    """Two lengths, a length beside pieces: where two programs read them differently, the second request is unseen."""
    call = json.dumps({"jsonrpc": "2.0", "id": 7, "method": "stage.stop", "params": {}}).encode()
    host = f"Host: 127.0.0.1:{site.port}"
    token = f"Authorization: Bearer {site.rig.tokens['operate']}"
    lines = ("POST /api/jsonrpc HTTP/1.1", host, token, JSON_TYPE, f"Content-Length: {len(call)}", "", "")
    hidden = "\r\n".join(lines).encode() + call
    last_piece = b"0\r\n\r\n"
    ways = (
        ("POST", "/api/jsonrpc", ("Content-Length: 2", f"Content-Length: {2 + len(hidden)}"), b"{}"),
        ("POST", "/api/jsonrpc", ("Content-Length: 2", "Transfer-Encoding: chunked"), last_piece),
        ("POST", "/api/jsonrpc", ("Transfer-Encoding: xchunked",), last_piece),
        ("GET", "/nothing", (f"Content-Length: {len(hidden)}",), b""),
    )
    replies = [site.raw(method, path, JSON_TYPE, *fields, body=begin + hidden, to_end=True, within_s=5)
               for method, path, fields, begin in ways]
    executed = [reply for reply in replies if b'"id":7' in reply.data.replace(b" ", b"")]
    return say(f"{replies}", not executed and all(reply.status in (None, 400, 404, 501) for reply in replies))
