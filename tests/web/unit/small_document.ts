// A document that is small enough to be seen through: what components draw, as markup, without a browser.
import "./browser_stand_in.ts";
import { type VNode, render } from "preact";

const escaped = (text: string): string => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;").replaceAll('"', "&quot;");

class SmallNode {
  parentNode: SmallElement | null = null;
  get nextSibling(): SmallNode | null {
    const all = this.parentNode?.childNodes ?? [];
    return all[all.indexOf(this) + 1] ?? null;
  }
  remove(): void {
    this.parentNode?.removeChild(this);
  }
  get markup(): string {
    return "";
  }
}

class SmallText extends SmallNode {
  readonly nodeType = 3;
  constructor(public data: string) {
    super();
  }
  override get markup(): string {
    return escaped(this.data);
  }
}

export class SmallElement extends SmallNode {
  readonly nodeType = 1;
  readonly childNodes: SmallNode[] = [];
  readonly given = new Map<string, string>();
  readonly style: Record<string, string> = {};
  readonly listeners = new Map<string, (event: unknown) => void>();
  constructor(readonly localName: string, readonly namespaceURI: string) {
    super();
  }
  get firstChild(): SmallNode | null {
    return this.childNodes[0] ?? null;
  }
  get attributes(): { name: string; value: string }[] {
    return [...this.given].map(([name, value]) => ({ name, value }));
  }
  insertBefore(node: SmallNode, before: SmallNode | null): SmallNode {
    node.remove();
    const at = before === null ? this.childNodes.length : this.childNodes.indexOf(before);
    this.childNodes.splice(at, 0, node);
    node.parentNode = this;
    return node;
  }
  removeChild(node: SmallNode): void {
    this.childNodes.splice(this.childNodes.indexOf(node), 1);
    node.parentNode = null;
  }
  setAttribute(name: string, value: unknown): void {
    this.given.set(name, String(value));
  }
  removeAttribute(name: string): void {
    this.given.delete(name);
  }
  addEventListener(name: string, listener: (event: unknown) => void): void {
    this.listeners.set(name, listener);
  }
  removeEventListener(name: string): void {
    this.listeners.delete(name);
  }
  getContext(): null {
    return null;  // nothing is painted
  }
  get children(): SmallElement[] {
    return this.childNodes.filter((node): node is SmallElement => node instanceof SmallElement);
  }
  get inner(): string {
    return this.childNodes.map((node) => node.markup).join("");
  }
  override get markup(): string {
    const attributes = [...this.given].map(([name, value]) => ` ${name}="${escaped(value)}"`).join("");
    return `<${this.localName}${attributes}>${this.inner}</${this.localName}>`;
  }
  // Elements of this name, or with this class (".name"), in the order of the document.
  all(wanted: string): SmallElement[] {
    const fits = wanted.startsWith(".") ? (this.given.get("class") ?? "").split(" ").includes(wanted.slice(1)) : this.localName === wanted;
    return [...(fits ? [this] : []), ...this.children.flatMap((child) => child.all(wanted))];
  }
  // What people read; blanks are one each.
  get text(): string {
    return this.childNodes.map((node) => (node instanceof SmallText ? node.data : node instanceof SmallElement ? node.text : "")).join("").replace(/\s+/g, " ").trim();
  }
}

const kHtml = "http://www.w3.org/1999/xhtml";
Object.assign(globalThis.document, {
  createElementNS: (namespace: string, name: string) => new SmallElement(name, namespace),
  createTextNode: (text: string) => new SmallText(text),
});

// What it draws now; what effects bring later is in it too, for the elements live on.
export function drawn(vnode: VNode): SmallElement {
  const body = new SmallElement("body", kHtml);
  render(vnode, body as unknown as Element);
  return body;
}
