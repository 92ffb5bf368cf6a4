// The pages in their states: an address, and what is done there before it is looked at.
//
//   name, says     of the state and its picture; also: more pictures of it, where they show something else: "dark", "de",
//                  "640" (200 % zoom)
//   token          of another role than "administer": null = none, "operator", or a token itself
//   before, after  of the station: calls that make the state, and take it back
//   prepare        what is done with the page; at: what its picture shows, if not the page's beginning
//   viewport, scale    of another screen, and of its picture
//   clock_ms       this browser's clock is wrong by so much; cut: there are no events
//   isPaper        as it is printed: no rules of the screen
//   mayFail        requests may fail

const press = (selector) => async (page) => {
  await page.locator(selector).first().click();
};
const kDay_ms = 86400000;
const kUhd = { viewport: { width: 3840, height: 2160 }, scale: 1 / 3 };
const kPart = ".start form input[type=text]";

// jobs: ids of valid results; recipe: an id; odd: ids of odd results, absent = none were made
export function statesOf({ jobs, recipe, odd }) {
  return [
    ...runStates(recipe, odd), ...historyStates(jobs, odd), ...resultStates(jobs, odd), ...recipeStates(recipe), ...setupStates(),
    { name: "no-such-page", path: "/nothing", mayFail: true, says: "An address that has no page, with the way back." },
  ];
}

function runStates(recipe, odd) {
  return [
    { name: "run", path: "/", also: ["dark", "de", "640"], says: "The run page after a part: state, button, live picture, map, values in their limits, last parts, alarms, devices." },
    { name: "run-looking-on", path: "/", token: null, says: "The run page without a token: everything is seen, and the button says why it does nothing." },
    { name: "run-3840", path: "/", ...kUhd, says: "The run page on a screen of 3840 x 2160, at a third of its size." },
    { name: "run-control-elsewhere", path: "/", token: "operator", before: lineTakesControl, after: releaseControl,
      says: "Somebody else has control: the page says who, and the button why it does not start." },
    { name: "run-part-too-long", path: "/", prepare: fill(kPart, "x".repeat(200)), says: "A part id of 200 characters: the field says how many there may be, and nothing is pushed away." },
    { name: "run-part-right-to-left", path: "/", prepare: fill(kPart, "\u05d7\u05dc\u05e7 12-\u05d0"), says: "A part id from right to left stands so in its field; the button says which characters the daemon takes." },
    { name: "run-clock-a-day-off", path: "/", clock_ms: kDay_ms, says: "The browser's clock is a day ahead: the page is the same." },
    { name: "line-lost", path: "/", cut: true, mayFail: true, says: "No events come: the banner says so, and that the daemon goes on." },
    { name: "log-in", path: "/", token: null, prepare: press(".session button"), says: "The dialog that asks for a token." },
    { name: "log-in-wrong", path: "/", token: null, mayFail: true, prepare: wrongLogIn, says: "A token that nobody has, typed into the dialog." },
    { name: "token-refused", path: "/", token: `fvd-${"0".repeat(64)}`, mayFail: true, prepare: seeRefusal, says: "A tab whose token is not valid any more says so and looks on." },
    ...(odd ? [
      { name: "run-nothing-valid", path: "/", also: ["dark"], before: measure("no_point"), after: (_, station) => measure(recipe)(station),
        says: "A part of which not one point is valid: the map says so and why, every measurement is invalid with its reason." },
      { name: "run-bare", path: "/", before: measure("bare"), after: (_, station) => measure(recipe)(station),
        says: "Limits to one side alone, values without U, and a verdict that comes from too few valid points." },
    ] : []),
  ];
}

function historyStates(jobs, odd) {
  return [
    { name: "history", path: "/jobs", also: ["640"], says: "The list of jobs with its filter, and the run chart of a value below." },
    { name: "history-chart", path: "/jobs", at: ".run-chart", also: ["dark"], says: "The run chart: value, U, limits, mean and three sigma." },
    { name: "history-compare", path: `/jobs?compare=${jobs.slice(-2).join(",")}`, says: "Two jobs beside each other, and the difference of their maps." },
    ...(odd ? [
      { name: "history-compare-nothing-valid", path: `/jobs?compare=${jobs.at(-1)},${odd.noPoint}`, says: "A comparison with a map without a valid point: no difference, and why." },
    ] : []),
  ];
}

function resultStates(jobs, odd) {
  const path = `/jobs/${jobs.at(-1)}`;
  return [
    { name: "result", path, also: ["dark", "de", "640"], says: "A result: map in 2D with the profile's line, values with U, limits and verdicts." },
    { name: "result-profile", path, at: ".profile-panel", also: ["dark"], says: "The profile with its band of standard errors, two cursors and what they tell." },
    { name: "result-details", path, prepare: openDetails, at: ".measurements", says: "Everything about a measurement: all values, budget, surface, section drawn into map and profile." },
    { name: "result-3d", path, prepare: press(".view-choice button:nth-child(2)"), says: "The surface in 3D with its exaggeration." },
    { name: "result-3840", path, ...kUhd, says: "A result on a screen of 3840 x 2160, at a third of its size." },
    { name: "result-print", path, isPaper: true, also: ["dark"], says: "A result as it is printed on A4: head, map, profile, all values with their budgets, conditions; light whatever the screen is." },
    { name: "result-unknown", path: "/jobs/no-such-job", mayFail: true, says: "A job that nobody knows." },
    ...(odd ? [
      { name: "result-nothing-valid", path: `/jobs/${odd.noPoint}`, says: "A result without a valid point: an empty map with the legend of what its holes are, invalid values with reasons." },
      { name: "result-bare", path: `/jobs/${odd.bare}`, says: "One-sided limits, values without U, and the map's own verdict in the table of values." },
      { name: "result-part-script", path: `/jobs/${odd.scripted}`, says: "A part that is called as a script: its name is text." },
      { name: "result-part-long", path: `/jobs/${odd.long}`, also: ["640"], says: "A part id of 64 characters without a blank, on its result." },
    ] : []),
  ];
}

function recipeStates(recipe) {
  return [
    { name: "recipes", path: "/recipes", says: "The recipes, and the ways to a new one." },
    { name: "recipe", path: `/recipes/${recipe}`, also: ["dark", "de", "640"], says: "The editor: form, regions on the newest map, what the daemon's checker says, saving." },
    { name: "recipe-new", path: "/recipes?new", says: "The assistant for a new recipe: its first step, the picture." },
  ];
}

function setupStates() {
  return [
    { name: "setup", path: "/setup", also: ["640"], says: "Set-up: stage and camera by hand; nothing moves before control is taken." },
    { name: "setup-looking-on", path: "/setup", token: null, says: "Set-up without a token: figures, and why nothing can be pressed." },
    { name: "setup-in-control", path: "/setup", also: ["dark", "de"], prepare: takeControl, after: releaseControl, says: "Set-up in control: jog with soft limits, autofocus, exposure, live picture." },
    { name: "setup-studies", path: "/setup?part=studies", says: "Studies: those that were made, and the form of a new one." },
    { name: "setup-study-faults", path: "/setup?part=studies", prepare: emptyStudy, at: "form.study", says: "A study's form that was sent empty: what is missing stands at its field." },
    { name: "setup-study-steps", path: "/setup?part=studies", prepare: stepStudy, at: "form.study", says: "The form of a calibration of z, with its steps." },
    { name: "setup-study-report", path: "/setup?part=studies", prepare: openStudy, at: "section:has(#report-title)", says: "The report of a study." },
    { name: "setup-devices", path: "/setup?part=devices", says: "Devices: health, counters, figures as sparklines." },
    { name: "setup-journal", path: "/setup?part=journal", says: "The journal: alarms, and who asked for what." },
  ];
}

// The run page shows the newest part.
const measure = (recipe) => async (station) => {
  const { scan } = await import("./station.mjs");
  await scan(station.call, { recipe });
};

function fill(selector, text) {
  return async (page) => {
    await page.locator(selector).first().fill(text);
    await page.locator(`${selector}[aria-invalid=true]`).first().waitFor();
  };
}

async function wrongLogIn(page) {
  await page.locator(".session > button").click();
  await page.locator(".session input[name=token]").fill("fvd-no-such-token");
  await page.locator(".session dialog button[type=submit]").click();
  await page.locator(".session dialog [role=alert]").waitFor();
}

async function seeRefusal(page) {
  await page.locator("header .refused").waitFor();
}

async function openDetails(page) {
  for (const button of ["[aria-expanded]", "[aria-pressed]"]) await page.locator(`.measurement-buttons button${button}`).first().click();
  await page.locator(".details-row").first().waitFor();
}

async function lineTakesControl(station) {
  await station.call("control.acquire", { owner: "line", lease_s: 600 });
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
