// Results with maps that are known, put into a station of its own (made_result.py).
import { execFileSync } from "node:child_process";
import { readFileSync, rmSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { scan } from "../../web/browser/station.mjs";

const program = join(dirname(fileURLToPath(import.meta.url)), "made_result.py");

// { jobs: ids, pitch_um: [x, y], width, height, heights_m: Float32Array }; the daemon was started anew, so it knows none
// of their files yet.
export async function makeResults(station, { width, height, copies = 1 }) {
  const [like] = await scan(station.call);
  let made;
  await station.restart({
    between: (state) => {
      const heights = join(state, "..", "heights.f32");
      const said = execFileSync("python3", [program, state, like, width, height, heights, copies].map(String), { encoding: "utf8" });
      const bytes = readFileSync(heights);
      rmSync(heights);
      made = { ...JSON.parse(said), width, height, heights_m: new Float32Array(bytes.buffer, bytes.byteOffset, width * height) };
    },
  });
  return made;
}
