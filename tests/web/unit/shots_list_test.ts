// The list of pictures is what the states say.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { join } from "node:path";
import test from "node:test";

declare const WEB_DIR: string;

test("each state has a name of its own and a sentence, and the list of pictures has them all", () => {
  const browser = join(WEB_DIR, "../../tests/web/browser");
  const check = spawnSync(process.execPath, [join(browser, "list_shots.mjs"), "--check"], { encoding: "utf8" });
  assert.equal(check.stderr, "");
  assert.equal(check.status, 0);
  const names = spawnSync(process.execPath, ["--input-type=module", "-e", `
    import { picturesOf } from ${JSON.stringify(join(browser, "shots.mjs"))};
    import { statesOf } from ${JSON.stringify(join(browser, "states.mjs"))};
    console.log(JSON.stringify(picturesOf(statesOf({ jobs: ["a", "b"], recipe: "groove", odd: {} }))));`], { encoding: "utf8" });
  assert.equal(names.stderr, "");
  const pictures = JSON.parse(names.stdout) as { name: string; says?: string }[];
  assert.ok(pictures.length > 50, String(pictures.length));
  assert.equal(new Set(pictures.map(({ name }) => name)).size, pictures.length);
  for (const { name, says } of pictures) {
    assert.match(name, /^[a-z0-9-]+$/);
    assert.match(says ?? "", /^[A-Z].*\.$/, name);
  }
});
