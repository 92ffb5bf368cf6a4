// What is looked at on a page in a state: rules of accessibility, overflow, small targets.
import { axeSource } from "./paths.mjs";

// Findings by weight; what was found is told to the error stream.
export async function axe(page, name) {
  await page.evaluate(axeSource);  // by the debugger: the page's own rules let no other script in
  const violations = await page.evaluate(async () => {
    const found = await window.axe.run(document, { resultTypes: ["violations"] });
    return found.violations.map(({ id, impact, help, nodes }) => ({ id, impact, help, at: nodes.map((node) => node.target.join(" ")), why: nodes[0]?.failureSummary ?? "" }));
  });
  const counts = { serious: 0, moderate: 0, minor: 0 };
  for (const { id, impact, help, at, why } of violations) {
    counts[impact === "critical" ? "serious" : impact ?? "minor"] += at.length;
    console.error(`axe ${impact} ${id} (${help}) in ${name}:\n  ${at.slice(0, 5).join("\n  ")}\n  ${why.replaceAll("\n", "\n  ")}`);
  }
  return counts;
}

// How many CSS pixels the page is wider than its window, and what sticks out.
export async function overflow(page, name) {
  const { over_px, who } = await page.evaluate(() => {
    const { scrollWidth, clientWidth } = document.documentElement;
    // What scrolls by itself may hold wide things.
    const isHeld = (element) => {
      for (let each = element.parentElement; each && each !== document.body; each = each.parentElement) {
        if (["auto", "scroll", "hidden", "clip"].includes(getComputedStyle(each).overflowX)) return true;
      }
      return false;
    };
    const who = [...document.body.querySelectorAll("*")].filter((element) => element.getBoundingClientRect().right > clientWidth + 1 && !isHeld(element));
    return { over_px: scrollWidth - clientWidth, who: who.slice(0, 6).map((element) => `${element.tagName.toLowerCase()}.${element.className} ${element.textContent.slice(0, 40)}`) };
  });
  if (over_px > 0) console.error(`overflow of ${over_px} px in ${name}:\n  ${who.join("\n  ")}`);
  return over_px > 0 ? 1 : 0;
}

// Buttons, fields and links that are buttons, lower or narrower than a gloved finger needs.
export async function smallTargets(page, name) {
  const found = await page.evaluate(() => {
    const least = 44;
    const kinds = "button, select, input:not([type=checkbox]):not([type=radio]):not([type=range]), textarea, summary, a.button, nav a, label.check";
    return [...document.querySelectorAll(kinds)].filter((element) => {
      const { width, height } = element.getBoundingClientRect();
      return element.checkVisibility?.() !== false && width > 1 && (height < least - 0.5 || width < least - 0.5);
    }).map((element) => `${element.tagName.toLowerCase()}.${element.className} "${(element.textContent || element.name).slice(0, 40)}" ${Math.round(element.getBoundingClientRect().width)} x ${Math.round(element.getBoundingClientRect().height)}`);
  });
  if (found.length > 0) console.error(`small targets in ${name}:\n  ${found.slice(0, 8).join("\n  ")}`);
  return found.length;
}

// What a printed result must have, and must not: how much of it is wrong.
export async function onPaper(page, name) {
  const wrong = await page.evaluate(() => {
    const isSeen = (selector) => [...document.querySelectorAll(selector)].some((element) => element.checkVisibility() && element.getBoundingClientRect().height > 0);
    const needed = [".result-head h1", ".result-head .verdict", ".map-canvas", ".colour-bar, .hole-legend", ".profile-plot canvas", ".print-only .measurements .details-row", ".print-only .conditions"];
    const gone = ["header.top", ".buttons", ".controls", ".downloads", ".screen-only"];
    const { backgroundColor, color } = getComputedStyle(document.body);
    return [
      ...needed.filter((each) => !isSeen(each)).map((each) => `${each} is missing`), ...gone.filter(isSeen).map((each) => `${each} is there`),
      ...(backgroundColor === "rgb(255, 255, 255)" && color === "rgb(0, 0, 0)" ? [] : [`${color} on ${backgroundColor}`]),
    ];
  });
  if (wrong.length > 0) console.error(`on paper, ${name}:\n  ${wrong.join("\n  ")}`);
  return wrong.length;
}
