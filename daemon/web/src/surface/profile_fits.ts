// Lines and circles through parts of a profile, and distances between two of its points.

export interface Points {
  x: readonly number[];
  y: readonly number[];
}

export interface LineFit {
  kind: "line";
  slope: number;
  at_zero: number;
  angle_deg: number;
  rms: number;  // of what is left, vertically
  points: number;
}

export interface CircleFit {
  kind: "circle";
  x: number;
  y: number;
  radius: number;
  convex: boolean;  // the centre lies below the points: the material has a round top
  rms: number;  // of the distances from the circle
  points: number;
}

// The points of a profile between two places; holes are left out.
export function partOf(distance: readonly number[], height: readonly (number | null)[], from: number, to: number): { x: number[]; y: number[] } {
  const [low, high] = from <= to ? [from, to] : [to, from];
  const part: { x: number[]; y: number[] } = { x: [], y: [] };
  distance.forEach((x, i) => {
    const y = height[i];
    if (x < low || x > high || y === null || y === undefined) return;
    part.x.push(x);
    part.y.push(y);
  });
  return part;
}

const mean = (values: readonly number[]): number => values.reduce((sum, value) => sum + value, 0) / values.length;

const rmsOf = (values: readonly number[]): number => Math.sqrt(values.reduce((sum, value) => sum + value * value, 0) / values.length);

// Least squares of the vertical distances. Null: fewer than two places.
export function fitLine({ x, y }: Points): LineFit | null {
  if (x.length < 2) return null;
  const x_mean = mean(x);
  const y_mean = mean(y);
  let sxx = 0;
  let sxy = 0;
  x.forEach((value, i) => {
    sxx += (value - x_mean) ** 2;
    sxy += (value - x_mean) * ((y[i] ?? NaN) - y_mean);
  });
  if (!(sxx > 0)) return null;
  const slope = sxy / sxx;
  const at_zero = y_mean - slope * x_mean;
  return {
    kind: "line", slope, at_zero, points: x.length,
    angle_deg: (Math.atan(slope) * 180) / Math.PI,
    rms: rmsOf(x.map((value, i) => (y[i] ?? NaN) - at_zero - slope * value)),
  };
}

interface Circle {
  x: number;
  y: number;
  radius: number;
}

// Algebraic (Kåsa): where the search for the least distances begins. The points are centred for the sake of rounding.
function roughCircle({ x, y }: Points): Circle | null {
  const x_mean = mean(x);
  const y_mean = mean(y);
  let suu = 0, suv = 0, svv = 0, suz = 0, svz = 0;
  x.forEach((value, i) => {
    const u = value - x_mean;
    const v = (y[i] ?? NaN) - y_mean;
    const z = u * u + v * v;
    suu += u * u; suv += u * v; svv += v * v; suz += u * z; svz += v * z;
  });
  const det = suu * svv - suv * suv;
  if (!(Math.abs(det) > 1e-12 * (suu + svv) ** 2)) return null;  // on a straight line
  const a = (suz * svv - svz * suv) / det / 2;
  const b = (svz * suu - suz * suv) / det / 2;
  return { x: a + x_mean, y: b + y_mean, radius: Math.sqrt(a * a + b * b + (suu + svv) / x.length) };
}

const costOf = (points: Points, circle: Circle): number =>
  points.x.reduce((sum, x, i) => sum + (Math.hypot(x - circle.x, (points.y[i] ?? NaN) - circle.y) - circle.radius) ** 2, 0);

// Solves a symmetric 3 x 3 system by elimination; null where it is singular.
function solve3(a: number[][], b: number[]): number[] | null {
  const rows = a.map((row, i) => [...row, b[i] ?? 0]);
  for (let i = 0; i < 3; ++i) {
    let pivot = i;
    for (let k = i + 1; k < 3; ++k) if (Math.abs(rows[k]![i]!) > Math.abs(rows[pivot]![i]!)) pivot = k;
    [rows[i], rows[pivot]] = [rows[pivot]!, rows[i]!];
    if (Math.abs(rows[i]![i]!) < 1e-300) return null;
    for (let k = 0; k < 3; ++k) {
      if (k === i) continue;
      const share = rows[k]![i]! / rows[i]![i]!;
      for (let j = i; j < 4; ++j) rows[k]![j]! -= share * rows[i]![j]!;
    }
  }
  return rows.map((row, i) => row[3]! / row[i]!);
}

const kSteps = 200;

// Least squares of the distances from the circle (Levenberg-Marquardt). Null: fewer than three points, or all on a line.
export function fitCircle(points: Points): CircleFit | null {
  if (points.x.length < 3) return null;
  let circle = roughCircle(points);
  if (!circle || !Number.isFinite(circle.radius)) return null;
  let cost = costOf(points, circle);
  let damping = 1e-3;
  for (let step = 0; step < kSteps; ++step) {
    const normal = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];
    const right = [0, 0, 0];
    points.x.forEach((x, i) => {
      const dx = x - circle!.x;
      const dy = (points.y[i] ?? NaN) - circle!.y;
      const away = Math.hypot(dx, dy) || 1e-300;
      const slopes = [-dx / away, -dy / away, -1];
      const rest = away - circle!.radius;
      for (let r = 0; r < 3; ++r) {
        right[r]! -= slopes[r]! * rest;
        for (let c = 0; c < 3; ++c) normal[r]![c]! += slopes[r]! * slopes[c]!;
      }
    });
    const change = solve3(normal.map((row, r) => row.map((value, c) => (r === c ? value * (1 + damping) : value))), right);
    if (!change) break;
    const next: Circle = { x: circle.x + change[0]!, y: circle.y + change[1]!, radius: circle.radius + change[2]! };
    const next_cost = costOf(points, next);
    if (next_cost <= cost && next.radius > 0) {
      const done = Math.hypot(...change) < 1e-12 * circle.radius;
      circle = next;
      cost = next_cost;
      damping = Math.max(1e-12, damping / 10);
      if (done) break;
    } else {
      damping *= 10;
      if (damping > 1e12) break;
    }
  }
  return {
    kind: "circle", ...circle, points: points.x.length,
    convex: circle.y < mean(points.y),
    rms: Math.sqrt(cost / points.x.length),
  };
}

// What to draw of a fit over [from, to]; null where a circle is not above or below a place.
export function fittedAt(fit: LineFit | CircleFit, x: number): number | null {
  if (fit.kind === "line") return fit.at_zero + fit.slope * x;
  const rest = fit.radius ** 2 - (x - fit.x) ** 2;
  return rest < 0 ? null : fit.y + (fit.convex ? 1 : -1) * Math.sqrt(rest);
}

export interface Between {
  dx: number;
  dz: number;
  angle_deg: number;
  length: number;
}

export function between(a: { x: number; z: number }, b: { x: number; z: number }): Between {
  const dx = b.x - a.x;
  const dz = b.z - a.z;
  return { dx, dz, angle_deg: (Math.atan2(dz, dx) * 180) / Math.PI, length: Math.hypot(dx, dz) };
}

// The profile's point nearest to a place; null where there are none, z null in a hole.
export function nearest(distance: readonly number[], height: readonly (number | null)[], at: number): { index: number; x: number; z: number | null } | null {
  if (distance.length === 0) return null;
  let index = 0;
  distance.forEach((x, i) => {
    if (Math.abs(x - at) < Math.abs((distance[index] ?? NaN) - at)) index = i;
  });
  return { index, x: distance[index] ?? NaN, z: height[index] ?? null };
}
