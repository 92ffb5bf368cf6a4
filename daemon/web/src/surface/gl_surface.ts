// Draws height fields by WebGL2: indexed triangles, colours at the vertices, parallel projection. No antialiasing: where
// a processor draws, it costs more than everything else.
import type { Mesh } from "./height_mesh.ts";

const kVertex = `#version 300 es
layout(location=0) in vec3 place;
layout(location=1) in vec4 colour;
uniform mat4 matrix;
out vec3 shown;
void main() {
  gl_Position = matrix * vec4(place, 1.0);
  shown = colour.rgb;
}`;

const kFragment = `#version 300 es
precision mediump float;
in vec3 shown;
out vec4 drawn;
void main() { drawn = vec4(shown, 1.0); }`;

interface Loaded {
  array: WebGLVertexArrayObject;
  buffers: WebGLBuffer[];
  count: number;
  mode: number;
}

export type Part = "coarse" | "fine" | "frame";

export class GlSurface {
  private readonly loaded = new Map<Part, Loaded>();
  private readonly matrix: WebGLUniformLocation | null;

  private constructor(private readonly gl: WebGL2RenderingContext, program: WebGLProgram) {
    gl.useProgram(program);
    gl.enable(gl.DEPTH_TEST);
    this.matrix = gl.getUniformLocation(program, "matrix");
  }

  // Null: this browser has no WebGL2.
  static on(canvas: HTMLCanvasElement): GlSurface | null {
    const gl = canvas.getContext("webgl2", { antialias: false, alpha: true });
    if (!gl || gl.isContextLost()) return null;
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, kVertex], [gl.FRAGMENT_SHADER, kFragment]] as const) {
      const shader = gl.createShader(kind);
      if (!shader) return null;
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    return gl.getProgramParameter(program, gl.LINK_STATUS) ? new GlSurface(gl, program) : null;
  }

  load(part: Part, positions: Float32Array, colours: Uint8Array, indices: Uint32Array, lines = false): void {
    const { gl } = this;
    this.drop(part);
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    const buffer = (target: number, data: Float32Array | Uint8Array | Uint32Array): WebGLBuffer => {
      const made = gl.createBuffer();
      gl.bindBuffer(target, made);
      gl.bufferData(target, data as AllowSharedBufferSource, gl.STATIC_DRAW);
      return made;
    };
    const buffers = [buffer(gl.ARRAY_BUFFER, positions)];
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    buffers.push(buffer(gl.ARRAY_BUFFER, colours));
    gl.enableVertexAttribArray(1);
    gl.vertexAttribPointer(1, 4, gl.UNSIGNED_BYTE, true, 0, 0);
    buffers.push(buffer(gl.ELEMENT_ARRAY_BUFFER, indices));
    gl.bindVertexArray(null);
    this.loaded.set(part, { array, buffers, count: indices.length, mode: lines ? gl.LINES : gl.TRIANGLES });
  }

  loadMesh(part: Part, { positions, colours, triangles }: Mesh): void {
    this.load(part, positions, colours, triangles);
  }

  draw(parts: readonly Part[], matrix: Float32Array, width: number, height: number): void {
    const { gl } = this;
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix4fv(this.matrix, false, matrix);
    for (const part of parts) {
      const found = this.loaded.get(part);
      if (!found) continue;
      gl.bindVertexArray(found.array);
      gl.drawElements(found.mode, found.count, gl.UNSIGNED_INT, 0);
    }
    gl.bindVertexArray(null);
  }

  private drop(part: Part): void {
    const found = this.loaded.get(part);
    if (!found) return;
    for (const buffer of found.buffers) this.gl.deleteBuffer(buffer);
    this.gl.deleteVertexArray(found.array);
    this.loaded.delete(part);
  }

  // Browsers allow few contexts: one that is not shown any more is given back at once.
  end(): void {
    for (const part of [...this.loaded.keys()]) this.drop(part);
    this.gl.getExtension("WEBGL_lose_context")?.loseContext();
  }
}

// The border of the map at a height, so that one sees where the surface ends and holes begin.
export function frameAt(width_um: number, height_um: number, z_um: number, grey: number): [Float32Array, Uint8Array, Uint32Array] {
  const [x, y] = [width_um / 2, height_um / 2];
  const positions = new Float32Array([-x, y, z_um, x, y, z_um, x, -y, z_um, -x, -y, z_um]);
  const colours = new Uint8Array(16).fill(grey);
  return [positions, colours, new Uint32Array([0, 1, 1, 2, 2, 3, 3, 0])];
}
