// The browser that the pages are tried in.
import { chromium } from "./paths.mjs";

export const openBrowser = (more = []) => chromium.launch({
  executablePath: process.env.FVD_CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", ...more],
  timeout: 120000,
});
