// Devices and disk as system.health tells them, which leaves out what a device has not.
type Keys = Record<string, unknown>;
const keysOf = (value: unknown): Keys => (typeof value === "object" && value !== null ? (value as Keys) : {});
const numberOf = (value: unknown): number | null => (typeof value === "number" && Number.isFinite(value) ? value : null);

export interface Device {
  isOpen: boolean;
  lost: number;   // openings beyond the first: so often it was lost
  faults: { name: string; count: number }[];   // counters above zero that tell of trouble
  temperatures_c: { name: string; celsius: number }[];
}

const kFaults = ["frames_failed", "underruns", "ids_skipped", "packets_missing", "unanswered", "refused", "reconnects"];

export function deviceOf(value: unknown): Device {
  const keys = keysOf(value);
  return {
    isOpen: keys["open"] === true,
    lost: Math.max(0, (numberOf(keys["openings"]) ?? 1) - 1),
    faults: kFaults.map((name) => ({ name, count: numberOf(keys[name]) ?? 0 })).filter(({ count }) => count > 0),
    temperatures_c: Object.entries(keysOf(keys["temperatures_c"]))
      .flatMap(([name, celsius]) => (numberOf(celsius) === null ? [] : [{ name, celsius: celsius as number }])),
  };
}

export interface Disk {
  free_gib: number;
  free_share: number;
  isLow: boolean;  // below a twentieth, or 5 GiB
}

export function diskOf(value: unknown): Disk | null {
  const keys = keysOf(value);
  const free = numberOf(keys["free_bytes"]);
  const size = numberOf(keys["size_bytes"]);
  if (free === null || size === null || size <= 0) return null;
  const free_gib = free / 2 ** 30;
  return { free_gib, free_share: free / size, isLow: free / size < 0.05 || free_gib < 5 };
}
