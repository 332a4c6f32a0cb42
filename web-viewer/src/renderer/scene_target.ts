import { texture } from "./table";

/**
 * The framebuffers of an image. `codes`: the spheres' codes and their depth as drawn, and the colours of all else.
 * `scene`: colours of all, and the depth of the surfaces. Each has textures that later passes read.
 */
export class SceneTarget {
  readonly code: WebGLTexture;
  readonly forward: WebGLTexture;
  readonly drawnDepth: WebGLTexture;
  readonly colour: WebGLTexture;
  readonly depth: WebGLTexture;
  private readonly codes: WebGLFramebuffer;
  private readonly scene: WebGLFramebuffer;
  private readonly none = Uint32Array.of(0, 0, 0, 0);
  private readonly found = new Uint32Array(1);

  constructor(
    private readonly gl: WebGL2RenderingContext,
    readonly width: number,
    readonly height: number,
  ) {
    this.code = texture(gl, gl.R32UI, width, height, gl.NEAREST);
    this.forward = texture(gl, gl.RGBA8, width, height, gl.NEAREST);
    this.drawnDepth = texture(gl, gl.DEPTH_COMPONENT24, width, height, gl.NEAREST);
    this.colour = texture(gl, gl.RGBA8, width, height, gl.LINEAR);
    this.depth = texture(gl, gl.DEPTH_COMPONENT24, width, height, gl.NEAREST);
    this.codes = framebuffer(gl, this.drawnDepth, this.forward, this.code);
    this.scene = framebuffer(gl, this.depth, this.colour);
  }

  /** Begins to draw what is no sphere, to `forward`. */
  beginForward(): void {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.codes);
    gl.viewport(0, 0, this.width, this.height);
    gl.drawBuffers([gl.COLOR_ATTACHMENT0, gl.COLOR_ATTACHMENT1]);
    gl.clearBufferuiv(gl.COLOR, 1, this.none);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.drawBuffers([gl.COLOR_ATTACHMENT0, gl.NONE]);
  }

  /** Begins to draw the spheres' codes. */
  beginCodes(): void {
    this.gl.drawBuffers([this.gl.NONE, this.gl.COLOR_ATTACHMENT1]);
  }

  /** Begins to draw to `colour` and `depth`; their content is undefined. */
  beginScene(): void {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.scene);
    gl.viewport(0, 0, this.width, this.height);
  }

  /** The code at a pixel, from the lower left corner. Waits until the image is drawn. */
  codeAt(x: number, y: number): number {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.codes);
    gl.readBuffer(gl.COLOR_ATTACHMENT1);
    gl.readPixels(x, y, 1, 1, gl.RED_INTEGER, gl.UNSIGNED_INT, this.found);
    return this.found[0] ?? 0;
  }

  free(): void {
    const { gl } = this;
    for (const used of [this.code, this.forward, this.drawnDepth, this.colour, this.depth]) gl.deleteTexture(used);
    gl.deleteFramebuffer(this.codes);
    gl.deleteFramebuffer(this.scene);
  }
}

function framebuffer(gl: WebGL2RenderingContext, depth: WebGLTexture, ...colours: WebGLTexture[]): WebGLFramebuffer {
  const made = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, made);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, depth, 0);
  colours.forEach((colour, k) => {
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + k, gl.TEXTURE_2D, colour, 0);
  });
  return made;
}
