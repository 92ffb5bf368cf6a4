// A scanner types as a keyboard does, but faster than a person and with Enter at its end. Keys that arrive so, wherever
// the focus is, are a part id; what a person types stays where it was typed.
export interface Scan {
  text: string;
  last_ms: number;
}

export const kNoScan: Scan = { text: "", last_ms: 0 };

const kGap_ms = 35;  // scanners send a key every 1 to 20 ms, a fast typist every 60 ms
const kLeast = 3;

export interface ScanStep {
  next: Scan;
  isBurst: boolean;         // this key belongs to a scan: it shall not press a button
  scanned: string | null;   // the whole code, at its end
}

export function takeKey(scan: Scan, key: string, now_ms: number): ScanStep {
  const goesOn = scan.text.length > 0 && now_ms - scan.last_ms <= kGap_ms;
  if (key === "Enter") {
    const isScan = goesOn && scan.text.length >= kLeast;
    return { next: kNoScan, isBurst: isScan, scanned: isScan ? scan.text : null };
  }
  // Shift of a capital letter comes between.
  if (key.length !== 1) return { next: scan, isBurst: false, scanned: null };
  const text = goesOn ? scan.text + key : key;
  return { next: { text, last_ms: now_ms }, isBurst: goesOn && text.length >= kLeast, scanned: null };
}
