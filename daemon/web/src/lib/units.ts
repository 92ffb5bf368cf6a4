// Units as the daemon writes them, and as people read them: "um3/um2" is µm³/µm²; a pure number has none.
const kWords: Record<string, string> = { "1": "", "um/um": "", deg: "°", percent: "%", "degree Celsius": "°C" };

export const shownUnit = (unit: string): string =>
  kWords[unit] ?? unit.replace(/\bu(?=[ms])/g, "µ").replace(/m\^?2\b/g, "m²").replace(/m\^?3\b/g, "m³");
