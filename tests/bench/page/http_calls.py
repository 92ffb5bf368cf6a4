"""HTTP as a client that is no browser speaks it."""

import http.client
import json
import socket
import time

import page_rig  # noqa: F401  # pylint: disable=unused-import  # it tells where rig is
from rig import ANSWER_TIMEOUT_S, Answer


class Http:
    """One connection, opened again where the server closed it."""

    def __init__(self, port, token=None):
        self.connection = http.client.HTTPConnection("127.0.0.1", port, timeout=ANSWER_TIMEOUT_S)
        self.own = {"Authorization": f"Bearer {token}"} if token else {}

    def exchange(self, method, path, body=None, **fields):
        """Status, fields with names in small letters, body."""
        named = {name.replace("_", "-"): value for name, value in fields.items()}
        for attempt in (1, 2):
            try:
                self.connection.request(method, path, body=body, headers=self.own | named)
                reply = self.connection.getresponse()
                return reply.status, {name.lower(): value for name, value in reply.getheaders()}, reply.read()
            except (http.client.RemoteDisconnected, ConnectionResetError, BrokenPipeError):
                self.connection.close()
                if attempt == 2:
                    raise

    def get(self, path, **fields):
        return self.exchange("GET", path, **fields)

    def call(self, method, **params):
        body = json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": params})
        status, _, text = self.exchange("POST", "/api/jsonrpc", body=body, Content_Type="application/json")
        answer = json.loads(text)
        if status != 200:
            raise Answer({"code": status, "message": answer.get("message", "")})
        if "error" in answer:
            raise Answer(answer["error"])
        return answer["result"]

    def close(self):
        self.connection.close()


class Reply:
    """What came back for bytes that were sent as they are. status: None where the connection ended without one."""

    def __init__(self, data, seconds):
        head, _, self.body = data.partition(b"\r\n\r\n")
        self.head = head.decode("latin-1")
        words = self.head.split(" ", 2)
        self.status = int(words[1]) if self.head.startswith("HTTP/1.1 ") and words[1].isdigit() else None
        self.seconds = seconds
        self.data = data

    def json(self):
        return json.loads(self.body)

    def __repr__(self):
        return f"{self.status} after {self.seconds:.2f} s: {self.body[:200]!r}"


def is_whole(data):
    head, end, body = data.partition(b"\r\n\r\n")
    if not end or head.startswith((b"HTTP/1.1 204", b"HTTP/1.1 304")):
        return bool(end)
    lengths = [line.split(b":")[1] for line in head.split(b"\r\n") if line.lower().startswith(b"content-length:")]
    return bool(lengths) and len(body) >= int(lengths[0])


def send_raw(port, data, within_s=30.0, pieces_s=None, to_end=False):
    """Sends bytes and reads one answer. pieces_s: a byte at a time with so long between; until the answer comes. to_end:
    reads whatever comes until the connection ends."""
    begun = time.monotonic()
    got = b""
    with socket.create_connection(("127.0.0.1", port), timeout=5) as line:
        try:
            if pieces_s is None:
                line.sendall(data)
            line.settimeout(pieces_s or within_s)
            sent = 0
            while time.monotonic() - begun < within_s and (to_end or not is_whole(got)):
                try:
                    more = line.recv(65536)
                    if not more:
                        break
                    got += more
                except TimeoutError:
                    if pieces_s is None:
                        break
                    line.sendall(data[sent:sent + 1])
                    sent += 1
        except (ConnectionError, BrokenPipeError):
            pass  # closed: what came before counts
    return Reply(got, time.monotonic() - begun)
