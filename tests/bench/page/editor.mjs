// Wrong and right recipes, typed into the editor: the page says of each what `fvd --check-recipe` says with the station's
// configuration, problem by problem, and points at the same places.
//
// node editor.mjs : FVD_PAGE_ROUNDS (220) recipes.
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { isDeepStrictEqual } from "node:util";
import { build, root } from "../../web/browser/paths.mjs";
import { openTab, visit } from "../../web/browser/tab.mjs";
import { mutated } from "./mutations.mjs";
import { phase, rounds } from "./phase.mjs";
import { generator } from "./random.mjs";

const id = "groove";
const kMostLines = 8;  // of the report of what differs

// said: what stands of each problem behind the recipe's name, in the program's order.
function byProgram(text, folder, options) {
  const file = join(folder, `${id}.json`);
  writeFileSync(file, text);
  const { status, stderr } = spawnSync(join(build, "daemon/fvd"), [...options, "--check-recipe", file], { encoding: "utf8" });
  const begin = `recipe ${id}: `;
  const said = stderr.split("\n").filter((line) => line !== "" && !line.startsWith(`${file}: note: `));
  const isTold = status === 0 ? said.length === 0 : status === 78 && said.length > 0 && said.every((line) => line.startsWith(begin));
  if (!isTold) throw new Error(`fvd --check-recipe ended with ${status} for ${text}: ${stderr}`);
  return { accepted: status === 0, said: said.map((line) => line.slice(begin.length)) };
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
        const said = [...check.querySelectorAll(".problems > li")].map((problem) => {
          const pointer = problem.querySelector("code")?.textContent;
          const why = problem.querySelector("span[lang]").textContent;
          return pointer === undefined ? why : `${pointer}: ${why}`;
        });
        return { state: check.dataset.state, said, head: check.querySelector("strong").innerText };
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
    const texts = mutated(JSON.parse(readFileSync(join(root, `config/recipes/${id}.json`), "utf8")), rounds(220), generator(3));
    const counts = { editor_checks: 0, editor_differs: 0, editor_accepted: 0, editor_refused: 0 };
    for (const text of texts) {
      const [program, shown] = [byProgram(text, folder, station.options), await byPage(page, text)];
      const isSame = shown.state === (program.accepted ? "good" : "bad") && isDeepStrictEqual(shown.said, program.said);
      ++counts[program.accepted ? "editor_accepted" : "editor_refused"];
      ++counts[isSame ? "editor_checks" : "editor_differs"];
      if (!isSame && counts.editor_differs <= kMostLines) console.error(`differs for ${text}\n  page: ${shown.head}\n    ${shown.said.join("\n    ")}\n  fvd: ${program.accepted ? "accepted" : program.said.join("\n    ")}`);
    }
    return counts;
  } finally {
    await close();
    rmSync(folder, { recursive: true, force: true });
  }
});
