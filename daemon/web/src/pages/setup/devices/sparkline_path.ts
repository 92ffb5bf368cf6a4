// Where the points of a curve lie in a picture; a value that never changes is a line in the middle.
export function pathOf(points: readonly [number, number][], width: number, height: number): string {
  const xs = points.map(([x]) => x);
  const ys = points.map(([, y]) => y);
  const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const atX = (x: number): number => (right > left ? ((x - left) / (right - left)) * width : width);
  const atY = (y: number): number => (high > low ? height - 2 - ((y - low) / (high - low)) * (height - 4) : height / 2);
  return points.map(([x, y]) => `${atX(x).toFixed(1)},${atY(y).toFixed(1)}`).join(" ");
}
