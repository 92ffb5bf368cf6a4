// A time of the daemon as people read it, in UTC as in its files; the text itself where it is no such time.
export const utcText = (utc: string): string => utc.replace(/^(\d{4}-\d\d-\d\d)T(\d\d:\d\d:\d\d)(?:\.\d+)?Z$/, "$1 $2Z");
