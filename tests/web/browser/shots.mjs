// Which pictures are kept of the states, and what they are called: each state in English and light, and what else it says.

// The file's name without its ending; empty where none is kept.
export function pictureOf({ name, also = [] }, { language, theme, isNarrow = false }) {
  const apart = [theme === "dark" ? "dark" : "", language === "de" ? "de" : "", isNarrow ? "640" : ""].filter(Boolean);
  if (apart.length === 0) return name;
  const [only] = apart;
  return apart.length === 1 && also.includes(only) ? `${name}-${only}` : "";
}

const kApart = { dark: "In dark colours.", de: "In German.", 640: "At 200 % zoom of 1280 x 1024." };

// [{ name, says }] in the order of the states.
export const picturesOf = (states) => states.flatMap((state) => [
  { name: state.name, says: state.says },
  ...(state.also ?? []).map((apart) => ({ name: `${state.name}-${apart}`, says: `The same. ${kApart[apart]}` })),
]);

export function listOf(states) {
  const rows = picturesOf(states).map(({ name, says }) => `| \`${name}.png\` | ${says} |\n`).join("");
  return `# tests/web/shots

What \`tests/web/browser/run.mjs\` photographs on its walk through all states, against a simulated groove: English and light, 1280 x 800, where nothing else is said. Made by \`tests/web/browser/list_shots.mjs\`.
The whole walk, in both languages and colours, is photographed into \`all/\` with \`--all-shots\`; that is not kept.

| picture | what it shows |
|---|---|
${rows}`;
}
