// Alarms, devices, disk, the last parts and who has control.
import assert from "node:assert/strict";
import test from "node:test";
import { ordered, timeForPeople } from "../../../daemon/web/src/run/alarm_order.ts";
import { deviceOf, diskOf } from "../../../daemon/web/src/run/health.ts";
import { ownerName } from "../../../daemon/web/src/rpc/owner_name.ts";

test("alarms that nobody saw stand first, the newest of them on top", () => {
  const alarm = (number: number, acknowledged: boolean) => ({ number, time_utc: "", last_utc: "", level: "error" as const, text: "", count: 1, acknowledged });
  const given = [alarm(1, true), alarm(2, false), alarm(3, true), alarm(4, false)];
  assert.deepEqual(ordered(given).map(({ number }) => number), [4, 2, 3, 1]);
  assert.deepEqual(given.map(({ number }) => number), [1, 2, 3, 4], "what was given stays as it was");
});

test("a time that is none is shown as it came", () => {
  assert.equal(timeForPeople("soon", "en"), "soon");
  assert.match(timeForPeople("2026-11-30T13:52:46Z", "de"), /30\.11\.26/);
});

test("a device: lost once for every opening after the first; counters of zero are no news", () => {
  const device = deviceOf({ open: true, openings: 3, frames_failed: 0, packets_missing: 2, temperatures_c: { driver: 41.2, odd: "x" } });
  assert.deepEqual(device, { isOpen: true, lost: 2, faults: [{ name: "packets_missing", count: 2 }], temperatures_c: [{ name: "driver", celsius: 41.2 }] });
  assert.deepEqual(deviceOf(null), { isOpen: false, lost: 0, faults: [], temperatures_c: [] });
});

test("a disk is low below a twentieth or 5 GiB", () => {
  const gib = 2 ** 30;
  assert.equal(diskOf({ free_bytes: 50 * gib, size_bytes: 100 * gib })?.isLow, false);
  assert.equal(diskOf({ free_bytes: 4 * gib, size_bytes: 10 * gib })?.isLow, true);
  assert.equal(diskOf({ free_bytes: 40 * gib, size_bytes: 1000 * gib })?.isLow, true);
  assert.equal(diskOf({ free_bytes: 1 }), null);
  assert.equal(diskOf({ free_bytes: 1, size_bytes: 0 }), null);
});

test("an owner's name has only what the daemon takes", () => {
  assert.equal(ownerName("token ops"), "page-ops");
  assert.equal(ownerName("token Müller & Söhne"), "page-M-ller-S-hne");
  assert.equal(ownerName(""), "page");
  assert.match(ownerName(`token ${"x".repeat(80)}`), /^[A-Za-z0-9._-]{1,32}$/);
});
