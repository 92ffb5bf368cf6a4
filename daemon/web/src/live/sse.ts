// The text of a stream of events (server-sent events), in whatever pieces it comes, as events. Pure.

export interface SseEvent {
  name: string;  // "message" where none was given
  data: string;
}

// One stream's. What follows an event's last whole line waits for the next piece; an event without its empty line is none.
export class SseParser {
  // Of the last event that was whole: where a reader goes on after a loss.
  lastId: string;
  // What the stream says about when to come again.
  retry_ms: number | null = null;

  private rest = "";
  private endsInReturn = false;
  private name = "";
  private data: string[] = [];
  private id: string;

  constructor(lastId = "") {
    this.lastId = lastId;
    this.id = lastId;
  }

  take(piece: string): SseEvent[] {
    // A line may end in both, which came in two pieces.
    if (this.endsInReturn && piece.startsWith("\n")) piece = piece.slice(1);
    else if (piece === "") return [];
    this.endsInReturn = piece === "" ? false : piece.endsWith("\r");
    const lines = (this.rest + piece).split(/\r\n|\n|\r/);
    this.rest = lines.pop() ?? "";
    const events: SseEvent[] = [];
    for (const line of lines) {
      if (line !== "") this.takeField(line);
      else this.endEvent(events);
    }
    return events;
  }

  private endEvent(events: SseEvent[]): void {
    this.lastId = this.id;
    if (this.data.length > 0) events.push({ name: this.name === "" ? "message" : this.name, data: this.data.join("\n") });
    this.name = "";
    this.data = [];
  }

  private takeField(line: string): void {
    const colon = line.indexOf(":");
    if (colon === 0) return;  // a comment
    const field = colon < 0 ? line : line.slice(0, colon);
    const value = colon < 0 ? "" : line.slice(colon + 1).replace(/^ /, "");
    if (field === "event") this.name = value;
    else if (field === "data") this.data.push(value);
    else if (field === "id" && !value.includes("\0")) this.id = value;
    else if (field === "retry" && /^[0-9]+$/.test(value)) this.retry_ms = Number(value);
  }
}
