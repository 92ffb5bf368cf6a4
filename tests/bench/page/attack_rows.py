"""The attacks that a request is: what is sent, and what must be answered. One row each."""

from attack_site import JSON_TYPE
from attack_special import (
    a_flood,
    a_guess,
    a_log_line,
    a_ninth_stream,
    a_slow_body,
    a_slow_header,
    a_smuggled_request,
    deep_brackets,
)

NOT_ALLOWED, INVALID_REQUEST, NO_JSON = 1004, -32600, -32700
MIB = 1 << 20


def status(*codes):
    """It is refused with one of these, and no page of another origin may read why."""
    return lambda reply: reply.status in codes and "access-control-allow" not in reply.head.lower()


def error(*codes):
    """The call is answered with one of these errors."""
    return lambda reply: reply.status == 200 and reply.json().get("error", {}).get("code") in codes


def no_field(name, *codes):
    return lambda reply: reply.status in codes and name.lower() not in reply.head.lower()


def true(outcome):
    """The row has looked by itself."""
    return bool(outcome)


def as_operator(site):
    """With a token that would be let in."""
    return {"token": site.rig.tokens["operate"]}


# name, what is done, what must be answered
ROWS = (
    ("rebinding: a call to a foreign name", lambda s: s.start(host="evil.example", **as_operator(s)), status(403)),
    ("rebinding: the page by a foreign name", lambda s: s.raw("GET", "/", host="evil.example"), status(403)),
    ("rebinding: events by a foreign name", lambda s: s.raw("GET", "/api/v1/events", host="evil.example"), status(403)),
    ("rebinding: a name that begins like an address", lambda s: s.start(host=f"127.0.0.1.evil.example:{s.port}"),
     status(403)),
    ("rebinding: two names", lambda s: s.start("Host: evil.example", **as_operator(s)), status(400)),
    ("cross origin: a call", lambda s: s.start("Origin: http://evil.example", **as_operator(s)), status(403)),
    ("cross origin: a page without an origin", lambda s: s.start("Origin: null", **as_operator(s)), status(403)),
    ("cross origin: another port of this machine", lambda s: s.start("Origin: http://127.0.0.1:1", **as_operator(s)),
     status(403)),
    ("cross origin: a map", lambda s: s.map("Origin: http://evil.example"), status(403)),
    ("cross origin: a picture in a foreign page",
     lambda s: s.raw("GET", "/api/v1/preview.jpg?after=0", "Sec-Fetch-Site: cross-site"), status(403)),
    ("cross origin: a form", lambda s: s.start("Content-Type: text/plain", **as_operator(s)), status(415)),
    ("cross origin: the question whether one may",
     lambda s: s.raw("OPTIONS", "/api/jsonrpc", "Origin: http://evil.example", "Access-Control-Request-Method: POST"),
     status(403, 405)),
    ("token: none, for what changes something", lambda s: s.start(), error(NOT_ALLOWED)),
    ("token: a wrong one", lambda s: s.start(token="0" * 64), status(401)),
    ("token: guesses, beside a right one", a_guess, true),
    ("token: in the address", lambda s: s.start(path=f"/api/jsonrpc?token={s.rig.tokens['operate']}"),
     error(NOT_ALLOWED)),
    ("token: of who looks, for a start", lambda s: s.start(token=s.rig.tokens["view"]), error(NOT_ALLOWED)),
    ("token: of an operator, for a recipe",
     lambda s: s.call("recipe.save", {"id": "part", "text": "{}", "base_version": 0, "author": "attack"}, **as_operator(s)),
     error(NOT_ALLOWED)),
    ("token: for a whole connection", lambda s: s.call("session.login", as_operator(s)), error(INVALID_REQUEST)),
    ("oversize: a body", lambda s: s.raw("POST", "/api/jsonrpc", JSON_TYPE, body=b" " * (MIB + 1)), status(413)),
    ("oversize: a header", lambda s: s.raw("GET", "/", f"X-Long: {'x' * 17000}"), status(431)),
    ("oversize: an address", lambda s: s.raw("GET", "/" + "x" * 3000), status(414)),
    ("oversize: brackets in brackets", deep_brackets, error(NO_JSON, INVALID_REQUEST)),
    ("slow loris: a header, byte by byte", a_slow_header, true),
    ("slow loris: a body that does not come", a_slow_body, true),
    ("slow loris: a hundred silent connections", a_flood, true),
    ("oversize: a ninth stream of events", a_ninth_stream, true),
    ("traversal: encoded", lambda s: s.file("..%2f..%2f..%2ffvd.sqlite"), status(400)),
    ("traversal: plain", lambda s: s.file("../../../fvd.sqlite"), status(400)),
    ("traversal: encoded twice", lambda s: s.file("%252e%252e%252ffvd.sqlite"), status(400, 404)),
    ("traversal: a file that is there and in no record", lambda s: s.file("beside.txt"), status(404)),
    ("traversal: a link in place of a file", lambda s: s.file(s.linked), status(404, 410, 500)),
    ("traversal: in the name of a job", lambda s: s.map(job="..%2f..%2f" + s.jobs[0]), status(400, 404)),
    ("injection: a header field by a file's name", lambda s: s.file("x%0d%0aSet-Cookie:%20a=b"),
     no_field("Set-Cookie", 400)),
    ("injection: a line of the log", a_log_line, true),
    ("injection: a request in another one's body", a_smuggled_request, true),
)
