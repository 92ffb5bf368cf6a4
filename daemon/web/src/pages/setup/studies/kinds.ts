// The studies, in the order in which a new station needs them. Titles and what to scan are in the message files.
export const kKinds = [
  ["verify", ["noise", "flatness", "step", "linearity", "hysteresis", "resolution", "sphere", "texture"]],
  ["calibrate", ["z", "lateral", "flatness", "noise", "texture"]],
  ["gauge", ["type1", "rr", "capability"]],
] as const;

// The guidance of a proposal is that of the test it rests on.
export const proposes = (method: string): boolean => method.startsWith("calibrate.");
