// Points of a map at full resolution, fetched in blocks where they are wanted: what is read out is what the file holds.
import { type Kind, type Tile, fetchTile } from "./height_tile.ts";

export const kBlock = 256;  // points a side
const kKept = 400;  // blocks, 100 MiB

export interface Point {
  column: number;
  row: number;
}

export const blockOf = (column: number, row: number): { x: number; y: number } => ({
  x: Math.floor(column / kBlock) * kBlock,
  y: Math.floor(row / kBlock) * kBlock,
});

export class FullMap {
  private blocks = new Map<string, Promise<Tile>>();

  constructor(
    readonly job: string,
    readonly width: number,
    readonly height: number,
    private readonly load: typeof fetchTile = fetchTile,
  ) {}

  has({ column, row }: Point): boolean {
    return column >= 0 && row >= 0 && column < this.width && row < this.height;
  }

  block(kind: Kind, column: number, row: number): Promise<Tile> {
    const { x, y } = blockOf(column, row);
    const key = `${kind} ${x} ${y}`;
    const known = this.blocks.get(key);
    this.blocks.delete(key);
    const window = { x, y, w: Math.min(kBlock, this.width - x), h: Math.min(kBlock, this.height - y) };
    const block = known ?? this.load(this.job, kind, window, kBlock);
    this.blocks.set(key, block);  // at the end: the first is the one that was not asked for longest
    if (!known) {
      block.catch(() => this.blocks.delete(key));  // a failure is not kept: the next one who asks tries again
      const oldest = this.blocks.keys().next().value;
      if (this.blocks.size > kKept && oldest !== undefined) this.blocks.delete(oldest);
    }
    return block;
  }

  async at(kind: Kind, { column, row }: Point): Promise<number> {
    return valueIn(await this.block(kind, column, row), column, row);
  }
}

// The value of a point of the whole map in a block that holds it.
export function valueIn(tile: Tile, column: number, row: number): number {
  return tile.mean[(row - tile.window.y) * tile.width + column - tile.window.x] ?? NaN;
}
