// Forms from the daemon's own description: all studies' parameters, and what is made of what was typed.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import test from "node:test";
import en from "../../../daemon/web/src/i18n/en.json" with { type: "json" };
import { idsIn, withId } from "../../../daemon/web/src/pages/setup/studies/ids_text.ts";
import { kKinds } from "../../../daemon/web/src/pages/setup/studies/kinds.ts";
import { type Field, type Method, fieldsOf, rangeText } from "../../../daemon/web/src/pages/setup/studies/study_fields.ts";
import { type Values, emptyValue, paramsOf } from "../../../daemon/web/src/pages/setup/studies/study_values.ts";

const kMethods = kKinds.flatMap(([group, names]) => names.map((name) => `${group}.${name}`));

declare const WEB_DIR: string;
const described = JSON.parse(readFileSync(join(WEB_DIR, "openrpc.json"), "utf8")) as { methods: Method[] };
const texts = en as Record<string, string>;

function fields(name: string): Field[] {
  const method = described.methods.find((each) => each.name === name);
  assert.ok(method, `the daemon has ${name}`);
  return fieldsOf(method);
}

const field = (method: string, name: string): Field => {
  const found = fields(method).find((each) => each.name === name);
  assert.ok(found, `${method} takes ${name}`);
  return found;
};

test("every study of the daemon is offered, with a title, a guidance and named parameters", () => {
  const ofDaemon = described.methods.map(({ name }) => name).filter((name) => /^(verify|calibrate|gauge)\./.test(name) && name !== "calibrate.accept");
  assert.deepEqual([...kMethods].sort(), ofDaemon.sort());
  for (const name of kMethods) {
    assert.ok(texts[`setup.kind.${name}`], `title of ${name}`);
    assert.ok(texts[`setup.guide.${name}`], `guidance of ${name}`);
    for (const each of fields(name)) {
      for (const { name: param } of [each, ...each.columns]) assert.ok(texts[`setup.param.${param}`], `name of ${name}'s ${param}`);
      for (const option of each.options) assert.ok(texts[`setup.choice.${option}`], `name of ${name}'s ${option}`);
    }
  }
});

test("kinds, units, ranges and defaults are those of the schema", () => {
  assert.equal(field("verify.noise", "jobs").kind, "jobs");
  assert.equal(field("verify.noise", "region").kind, "region");
  assert.equal(field("verify.hysteresis", "down").kind, "job");
  assert.equal(field("gauge.capability", "rr").kind, "study");
  assert.equal(field("verify.sphere", "bowl").kind, "flag");
  assert.deepEqual(field("verify.resolution", "artefact").options, ["star", "edge"]);
  const radius = field("verify.sphere", "radius_um");
  assert.deepEqual([radius.kind, radius.unit, radius.required, radius.isOpen], ["number", "um", true, true]);
  assert.equal(rangeText(radius, String), "0 < …");
  assert.equal(rangeText(field("gauge.rr", "trials"), String), "2 ≤ … ≤ 100");
  assert.equal(field("gauge.rr", "pooling_p").fallback, 0.25);
  const steps = field("verify.step", "steps");
  assert.equal(steps.kind, "rows");
  assert.deepEqual(steps.columns.map(({ name, required }) => [name, required]),
    [["job", true], ["measurement", true], ["value", false], ["reference_um", true], ["u_reference_um", true]]);
});

test("empty forms say what is missing and send nothing that was not typed", () => {
  for (const name of kMethods) {
    const { params, faults } = paramsOf(fields(name), {});
    for (const each of fields(name).filter(({ required, kind }) => required && kind !== "choice" && kind !== "flag")) {
      assert.ok(Object.keys(faults).some((at) => at === each.name || at.startsWith(`${each.name}.`)), `${name}: ${each.name}`);
    }
    for (const key of Object.keys(params)) {
      assert.ok(["jobs", "steps", "artefact"].includes(key), `${name} would send ${key}`);
    }
  }
});

test("a whole form becomes the daemon's parameters", () => {
  const values: Values = {
    steps: [{ job: " a ", measurement: "step", value: "height_um", reference_um: "10,02", u_reference_um: "0.01" }],
    u_common_relative: "1e-4",
    require_calibration: true,
    person: "",
  };
  assert.deepEqual(paramsOf(fields("calibrate.z"), values), {
    params: {
      steps: [{ job: "a", measurement: "step", value: "height_um", reference_um: 10.02, u_reference_um: 0.01 }],
      u_common_relative: 0.0001,
      require_calibration: true,
    },
    faults: {},
  });
});

test("regions", () => {
  const jobs = ["a", "b"];
  const of = (region: Values[string]) => paramsOf(fields("verify.noise"), { jobs, region });
  assert.deepEqual(of({ shape: "", numbers: {} }).params, { jobs });
  assert.deepEqual(of({ shape: "circle_um", numbers: { x: "1", y: "-2", radius: "3,5" } }).params, { jobs, region: { circle_um: { x: 1, y: -2, radius: 3.5 } } });
  assert.deepEqual(of({ shape: "rectangle_um", numbers: { x: "1", y: "", width: "0", height: "2" } }).faults, { "region.y": "no_number", "region.width": "too_small" });
});

test("faults of numbers", () => {
  const faultOf = (method: string, name: string, text: string) => paramsOf(fields(method), { [name]: text }).faults[name];
  assert.equal(faultOf("gauge.rr", "trials", "2,5"), "no_integer");
  assert.equal(faultOf("gauge.rr", "trials", "1"), "too_small");
  assert.equal(faultOf("gauge.rr", "trials", "101"), "too_large");
  assert.equal(faultOf("gauge.rr", "trials", "three"), "no_number");
  assert.equal(faultOf("gauge.rr", "trials", "3"), undefined);
  assert.equal(faultOf("verify.sphere", "radius_um", "0"), "too_small");
});

test("values of all kinds are empty at first", () => {
  assert.equal(emptyValue(field("verify.sphere", "bowl")), false);
  assert.equal(emptyValue(field("verify.resolution", "artefact")), "star");
  assert.deepEqual(emptyValue(field("verify.noise", "jobs")), []);
});

test("ids keep their order and come once", () => {
  assert.deepEqual(idsIn("b\n a, b;c\n"), ["b", "a", "c"]);
  assert.deepEqual(withId(["b", "a"], "c", true), ["b", "a", "c"]);
  assert.deepEqual(withId(["b", "a"], "b", true), ["b", "a"]);
  assert.deepEqual(withId(["b", "a"], "b", false), ["a"]);
});
