// The run page as somebody at the station uses it, with the moments at which he pressed and saw.
import { openTab, visit } from "../../web/browser/tab.mjs";
import { until } from "../../web/browser/wait.mjs";
import { offsetOf } from "./clock.mjs";

export class RunPageTab {
  static async open(browser, station, figures) {
    const tab = await openTab(browser, station, figures, { token: station.operator, mayMove: true });
    await visit(tab.page, station, "/");
    await tab.page.evaluate(() => {
      window.fvdKeys = {};
      addEventListener("keydown", ({ key, timeStamp }) => void (window.fvdKeys[key] = timeStamp), { capture: true });
    });
    return new RunPageTab(tab, station, await offsetOf(tab.page));
  }

  constructor(tab, station, offset_ms) {
    Object.assign(this, { tab, page: tab.page, station, offset_ms });
  }

  async choose(part, recipe) {
    await this.page.locator(".start select").selectOption(recipe);
    await this.page.locator(".start form input[type=text]").fill(part);
    await this.page.locator(".one-button button.one-start[aria-disabled=false]").waitFor();
  }

  // When the browser had the key.
  async press(key) {
    await this.page.keyboard.press(key);
    return this.offset_ms + await this.page.evaluate((name) => window.fvdKeys[name], key);
  }

  // The job that the page started for this part.
  jobOf(part) {
    return until(`a job of ${part}`, async () => {
      const { newest_seq } = await this.station.call("job.latest", { client: "page" });
      if (newest_seq === 0) return null;
      const status = await this.station.call("job.status", { client: "page", seq: newest_seq });
      return status.part_id === part ? status : null;
    });
  }

  // When map, verdict and values of the part were on the screen: a frame after they were drawn.
  async shownAt(part) {
    return this.offset_ms + await this.page.evaluate((wanted) => new Promise((tell) => {
      const isOf = (panel) => panel?.querySelector("h2 .part-id")?.textContent === wanted && !panel.querySelector("h2 .tag");
      const isShown = () => {
        const map = document.querySelector("section.map");
        const values = document.querySelector("section.results");
        const canvas = map?.querySelector(".height-map .picture canvas");
        const isPainted = canvas && (canvas.width !== 300 || canvas.height !== 150);  // the size of one that nobody painted
        return isOf(map) && isOf(values) && isPainted && values.querySelector(".big-verdict .verdict") && values.querySelector("table.values tbody tr");
      };
      const look = () => requestAnimationFrame(isShown() ? () => tell(performance.now()) : look);
      look();
    }), part);
  }

  close() {
    return this.tab.close();
  }
}
