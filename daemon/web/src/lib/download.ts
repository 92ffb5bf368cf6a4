// Gives a text to the browser as a file.
export function download(name: string, type: string, text: string): void {
  const address = URL.createObjectURL(new Blob([text], { type }));
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
  // Firefox reads it after the click was dealt with.
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}
