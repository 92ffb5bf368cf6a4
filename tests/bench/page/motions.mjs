// Follows what fvd-sim writes of its stage: "NS move 20.000000", "stop", "home", "moving", "still".
import { closeSync, openSync, readSync } from "node:fs";
import { until } from "../../web/browser/wait.mjs";

export class Motions {
  constructor(file) {
    this.file = openSync(file, "r");
    this.at = 0;
    this.partial = "";
    this.lines = [];
  }

  // What came since the last call.
  read() {
    const bytes = Buffer.alloc(65536);
    for (;;) {
      const count = readSync(this.file, bytes, 0, bytes.length, this.at);
      if (count === 0) return;
      this.at += count;
      const lines = (this.partial + bytes.toString("ascii", 0, count)).split("\n");
      this.partial = lines.pop();
      for (const line of lines) {
        const blank = line.indexOf(" ");
        this.lines.push({ at_ms: Number(BigInt(line.slice(0, blank)) / 1000n) / 1000, words: line.slice(blank + 1) });
      }
    }
  }

  // When the first line since then came that begins so.
  awaitLine(begin, since_ms, within_ms = 30000) {
    return until(`the stage's '${begin}'`, () => {
      this.read();
      return this.lines.find(({ at_ms, words }) => at_ms >= since_ms && words.startsWith(begin))?.at_ms;
    }, within_ms);
  }

  close() {
    closeSync(this.file);
  }
}
