import assert from "node:assert/strict";
import { test } from "node:test";
import { type SseEvent, SseParser } from "../../../daemon/web/src/live/sse.ts";

const all = (parser: SseParser, ...pieces: string[]): SseEvent[] => pieces.flatMap((piece) => parser.take(piece));

test("events have a name and data, a message where there is no name", () => {
  const parser = new SseParser();
  assert.deepEqual(all(parser, 'event: state\ndata: {"a":1}\n\ndata:x\ndata: y\n\n'), [
    { name: "state", data: '{"a":1}' },
    { name: "message", data: "x\ny" },
  ]);
});

test("an event does not depend on the pieces in which it comes", () => {
  const text = "retry: 2000\n\nid: 17-1\r\nevent: job\r\ndata: a: b \r\n\r\nid: 17-2\revent: ping\rdata: {}\r\r";
  const whole = all(new SseParser(), text);
  assert.deepEqual(whole, [{ name: "job", data: "a: b " }, { name: "ping", data: "{}" }]);
  for (let size = 1; size < text.length; ++size) {
    const parser = new SseParser();
    const pieces = Array.from({ length: Math.ceil(text.length / size) }, (_, i) => text.slice(i * size, (i + 1) * size));
    assert.deepEqual(all(parser, ...pieces), whole, `pieces of ${size}`);
    assert.equal(parser.lastId, "17-2");
    assert.equal(parser.retry_ms, 2000);
  }
});

test("an id counts once its event is whole, and stays for those without one", () => {
  const parser = new SseParser("17-4");
  assert.equal(parser.lastId, "17-4");
  all(parser, "id: 17-5\nevent: state\ndata: 1\n");
  assert.equal(parser.lastId, "17-4");
  assert.deepEqual(all(parser, "\n"), [{ name: "state", data: "1" }]);
  assert.equal(parser.lastId, "17-5");
  all(parser, "event: ping\ndata: {}\n\n");
  assert.equal(parser.lastId, "17-5");
  all(parser, "id: 17-6\n\n");
  assert.equal(parser.lastId, "17-6", "an event without data is none, and its id counts");
});

test("what means nothing is left out", () => {
  const parser = new SseParser("17-4");
  assert.deepEqual(all(parser, ": a comment\n\nevent: state\n\nid: a\0b\nretry: soon\nretry: -1\nretry:\nother: x\nnothing\n\n"), []);
  assert.equal(parser.lastId, "17-4");
  assert.equal(parser.retry_ms, null);
  assert.deepEqual(all(parser, "data\n\n"), [{ name: "message", data: "" }]);
  assert.deepEqual(all(parser, "data: the end is missing"), []);
  assert.deepEqual(all(parser, "", ""), []);
});
