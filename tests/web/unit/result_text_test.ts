import assert from "node:assert/strict";
import test from "node:test";
import "./browser_stand_in.ts";
import { keepDraft, readDraft } from "../../../daemon/web/src/recipe/draft.ts";
import { sPoints, shapesOf } from "../../../daemon/web/src/result/fitted_geometry.ts";
import { freeName, measurementNames, profileMeasurement, withMeasurement } from "../../../daemon/web/src/result/recipe_draft.ts";
import type { Measurement, ResultJson } from "../../../daemon/web/src/result/result_json.ts";
import { mapOwner, measurementsOf } from "../../../daemon/web/src/result/result_json.ts";
import { nameOf, percentDigits } from "../../../daemon/web/src/result/value_text.ts";

test("names and shares for people", () => {
  assert.equal(nameOf("height_areal_um"), "height areal");
  assert.equal(nameOf("K"), "K");
  assert.deepEqual([1, 0.9999, 0.97548, 0, 0.0001].map(percentDigits), [100, 99.9, 97.5, 0, 0.1]);
});

const edge: Measurement = {
  kind: "cutting_edge", values: {},
  details: { sections: [{ along_um: 5, x_um: 50, y_um: 5 }, { along_um: 15, x_um: 50, y_um: 15, unmeasured: "holes" }], chipping: { notches: [{ along_um: 7, x_um: 51, y_um: 7, depth_um: 3, width_um: 9 }] } },
  cross_section: {
    from_x_um: 0, from_y_um: 10, to_x_um: 100, to_y_um: 10, band_width_um: 4,
    regions: [{ name: "flank", from_um: 10, to_um: 30 }, { name: "flank", from_um: 70, to_um: 90 }],
    fit: [{ along_um: [10, 45, 50, 55, 90], z_um: [0, 35, 37, 35, 0] }],
  },
};

test("an edge shows its band, flanks, S points, sections and notches", () => {
  assert.deepEqual(sPoints(edge).map(({ along_um }) => along_um), [45, 55]);
  const shapes = shapesOf(edge);
  assert.deepEqual(shapes.map(({ kind }) => kind), ["band", "region", "region", "s_point", "s_point", "section", "unmeasured", "notch"]);
  assert.deepEqual(shapes[1]?.points, [{ x: 10, y: 8 }, { x: 30, y: 8 }, { x: 30, y: 12 }, { x: 10, y: 12 }]);
  assert.deepEqual(shapes[5]?.points, [{ x: 10, y: 5 }, { x: 90, y: 5 }]);
  assert.deepEqual(shapesOf({ kind: "areal", values: {} }), []);
});

test("measurements come in the recipe's order; an evaluation's map is its source's", () => {
  const result = { job: { job_id: "j-e1" }, source: { job_id: "j" }, evaluation: { order: ["b", "gone", "a"], measurements: { a: edge, b: edge } } } as unknown as ResultJson;
  assert.deepEqual(measurementsOf(result).map(([name]) => name), ["b", "a"]);
  assert.equal(mapOwner(result), "j");
  assert.deepEqual(measurementsOf({ job: { job_id: "j" }, verdict: null } as ResultJson), []);
});

test("a measurement joins the others of the recipe's draft", () => {
  const profile = profileMeasurement({ from: { x: 1.00004, y: 2 }, to: { x: 3, y: 4 }, width_um: 0 }, ["Pt"]);
  assert.deepEqual(profile, { kind: "profile", from_um: [1, 2], to_um: [3, 4], parameters: ["Pt"] });
  const text = withMeasurement('{"format": 2, "evaluation": {"regions": {"r": 1}, "measurements": {"a": {"kind": "areal"}}}}', "p", profile);
  assert.deepEqual(JSON.parse(text), { format: 2, evaluation: { regions: { r: 1 }, measurements: { a: { kind: "areal" }, p: profile } } });
  assert.deepEqual(measurementNames(text), ["a", "p"]);
  assert.deepEqual(measurementNames(withMeasurement("{}", "p", profile)), ["p"]);
  assert.throws(() => withMeasurement('{"format": 2,', "p", profile));
  assert.equal(freeName(["profile", "profile_2"]), "profile_3");
});

test("a draft is read back as it was kept, and nothing else is taken for one", () => {
  assert.equal(readDraft("groove"), null);
  keepDraft("groove", { text: "{}", base_version: 3 });
  assert.deepEqual(readDraft("groove"), { text: "{}", base_version: 3 });
  assert.equal(readDraft("edge"), null);
  for (const wrong of ["{", "7", '{"text": 5, "base_version": 1}']) {
    sessionStorage.setItem("fvd.draft.groove", wrong);
    assert.equal(readDraft("groove"), null);
  }
});
