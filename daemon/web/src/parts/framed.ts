// The frame of a picture: as wide as there is room, not higher than most of the window, its sides in proportion.
export const framed = (width: number, height: number): Record<string, string> =>
  ({ aspectRatio: `${width} / ${height}`, maxWidth: `calc(60vh * ${width / height})` });
