// 200 wrong and right recipes, typed into the editor: the page says of each what `fvd --check-recipe` says, and points
// at the same places.
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { build, root } from "../../web/browser/paths.mjs";
import { openTab, visit } from "../../web/browser/tab.mjs";
import { mutated } from "./mutations.mjs";
import { phase, rounds } from "./phase.mjs";
import { generator } from "./random.mjs";

const id = "groove";
const kMostLines = 8;  // of the report of what differs

function byProgram(text, folder) {
  const file = join(folder, `${id}.json`);
  writeFileSync(file, text);
  const { status, stderr } = spawnSync(join(build, "daemon/fvd"), ["--check-recipe", file], { encoding: "utf8" });
  if (status !== 0 && status !== 78) throw new Error(`fvd --check-recipe ended with ${status}: ${stderr}`);
  const pointers = stderr.split("\n").flatMap((line) => {
    const found = /^recipe groove: (\/\S*): /.exec(line);
    return found ? [found[1]] : [];
  });
  return { accepted: status === 0, pointers: pointers.sort(), said: stderr };
}

// Types it and waits for what the daemon says of this very text.
async function byPage(page, text) {
  return page.evaluate(async (typed) => {
    const area = document.getElementById("recipe-text");
    area.value = typed;
    area.dispatchEvent(new InputEvent("input", { bubbles: true }));
    for (let frames = 0; frames < 2; ++frames) await new Promise(requestAnimationFrame);  // it is drawn as not checked yet
    const asked = performance.now();
    for (;;) {
      const check = document.querySelector(".check[data-state]");
      if (check && check.dataset.state !== "checking") {
        const pointers = [...check.querySelectorAll(".problems code")].map(({ textContent }) => textContent);
        return { state: check.dataset.state, pointers: pointers.sort(), said: check.innerText };
      }
      if (performance.now() - asked > 20000) throw new Error("the editor says nothing");
      await new Promise(requestAnimationFrame);
    }
  }, text);
}

await phase(async ({ browser, station, figures }) => {
  const folder = mkdtempSync(join(tmpdir(), "fvd-editor-"));
  const { page, close } = await openTab(browser, station, figures);
  try {
    await visit(page, station, `/recipes/${id}`);
    await page.locator("#recipe-text").waitFor();
    const texts = mutated(JSON.parse(readFileSync(join(root, `config/recipes/${id}.json`), "utf8")), rounds(200), generator(3));
    const counts = { editor_checks: 0, editor_differs: 0, editor_accepted: 0, editor_refused: 0 };
    for (const text of texts) {
      const [program, shown] = [byProgram(text, folder), await byPage(page, text)];
      const isSame = (shown.state === "good") === program.accepted && shown.state !== "failed" && shown.pointers.join("\n") === program.pointers.join("\n");
      ++counts[program.accepted ? "editor_accepted" : "editor_refused"];
      ++counts[isSame ? "editor_checks" : "editor_differs"];
      if (!isSame && counts.editor_differs <= kMostLines) console.error(`differs for ${text}\n  page (${shown.state}): ${shown.said}\n  fvd: ${program.said}`);
    }
    return counts;
  } finally {
    await close();
    rmSync(folder, { recursive: true, force: true });
  }
});
