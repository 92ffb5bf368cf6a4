// How this page calls itself as owner of control: letters, digits, '.', '_' and '-', at most 32.
export function ownerName(who: string): string {
  const short = who.replace(/^token /, "").replace(/[^A-Za-z0-9._-]+/g, "-").replace(/^-+|-+$/g, "");
  return `page-${short}`.replace(/-$/, "").slice(0, 32);
}
