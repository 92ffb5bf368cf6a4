// The pages in their states: an address, and what is done there before it is looked at.

const press = (selector) => async (page) => {
  await page.locator(selector).first().click();
};

// jobs: ids of valid results; recipe: an id
export function statesOf({ jobs, recipe }) {
  return [
    { name: "run", path: "/" },
    { name: "run-looking-on", path: "/", token: null },
    { name: "log-in", path: "/", token: null, prepare: press(".session button") },
    { name: "history", path: "/jobs" },
    { name: "result", path: `/jobs/${jobs.at(-1)}` },
    { name: "result-unknown", path: "/jobs/no-such-job", mayFail: true },
    { name: "recipes", path: "/recipes" },
    { name: "recipe", path: `/recipes/${recipe}` },
    { name: "setup", path: "/setup" },
    { name: "setup-looking-on", path: "/setup", token: null },
    { name: "setup-in-control", path: "/setup", prepare: takeControl, after: releaseControl },
    { name: "setup-studies", path: "/setup?part=studies" },
    { name: "setup-study-faults", path: "/setup?part=studies", prepare: emptyStudy },
    { name: "setup-study-steps", path: "/setup?part=studies", prepare: stepStudy },
    { name: "setup-study-report", path: "/setup?part=studies", prepare: openStudy },
    { name: "setup-devices", path: "/setup?part=devices" },
    { name: "setup-journal", path: "/setup?part=journal" },
    { name: "no-such-page", path: "/nothing" },
    { name: "line-lost", path: "/", cut: true, mayFail: true },
  ];
}

async function takeControl(page) {
  const button = page.locator(".control-strip button:not(.stop)");
  await button.click();
  await page.locator(".jog:enabled").first().waitFor();
}

async function releaseControl(page, station) {
  await station.call("control.release");
}

async function emptyStudy(page) {
  await page.locator("form.study button[type=submit]").click();
  await page.locator("form.study [role=alert]").waitFor();
}

async function stepStudy(page) {
  await page.locator("select:has(optgroup)").selectOption("calibrate.z");
  await page.locator("form.study fieldset.row").waitFor();
  await page.locator("form.study details summary").first().click();
}

async function openStudy(page) {
  await page.locator("section:has(#studies-title) td button").first().click();
  await page.locator("#report-title").waitFor();
}
