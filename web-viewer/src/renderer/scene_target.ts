import { texture } from "./table";

/**
 * The framebuffers of an image. `code`: the spheres' codes and their depth as drawn, and the colours of all else.
 * `scene`: colours of all, and the depth of the surfaces. Each has textures that later passes read.
 */
export class SceneTarget {
  readonly code: WebGLTexture;
  readonly forward: WebGLTexture;
  readonly drawnDepth: WebGLTexture;
  readonly colour: WebGLTexture;
  readonly depth: WebGLTexture;
  private readonly forwardTarget: WebGLFramebuffer;
  private readonly codeTarget: WebGLFramebuffer;
  private readonly scene: WebGLFramebuffer;
  private readonly none = Uint32Array.of(0, 0, 0, 0);

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
    this.forwardTarget = framebuffer(gl, this.drawnDepth, this.forward);
    this.codeTarget = framebuffer(gl, this.drawnDepth, undefined, this.code);
    this.scene = framebuffer(gl, this.depth, this.colour);
  }

  /** Begins to draw background, floor and obstacles, to `forward`. */
  beginForward(): void {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.forwardTarget);
    gl.viewport(0, 0, this.width, this.height);
    gl.clear(gl.DEPTH_BUFFER_BIT);
  }

  /** Begins to draw the spheres' codes. */
  beginCodes(): void {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.codeTarget);
    gl.clearBufferuiv(gl.COLOR, 1, this.none);
  }

  /** Begins to draw to `colour` and `depth`; their content is undefined. */
  beginScene(): void {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.scene);
    gl.viewport(0, 0, this.width, this.height);
  }

  /** The codes of a part of the image, from its lower left corner. Waits until the image is drawn. */
  codes(x: number, y: number, width: number, height: number): Uint32Array {
    const { gl } = this;
    const found = new Uint32Array(width * height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.codeTarget);
    gl.readBuffer(gl.COLOR_ATTACHMENT1);
    gl.readPixels(x, y, width, height, gl.RED_INTEGER, gl.UNSIGNED_INT, found);
    return found;
  }

  free(): void {
    const { gl } = this;
    for (const used of [this.code, this.forward, this.drawnDepth, this.colour, this.depth]) gl.deleteTexture(used);
    gl.deleteFramebuffer(this.forwardTarget);
    gl.deleteFramebuffer(this.codeTarget);
    gl.deleteFramebuffer(this.scene);
  }
}

/** The place in a code of shaders/place.glsl; undefined if there is no sphere. */
export function placeIn(code: number): number | undefined {
  return code === 0 ? undefined : code & 0xffffff;
}

/** `colours`: the attachments in their order; undefined: nothing is drawn there. */
function framebuffer(
  gl: WebGL2RenderingContext,
  depth: WebGLTexture,
  ...colours: (WebGLTexture | undefined)[]
): WebGLFramebuffer {
  const made = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, made);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, depth, 0);
  colours.forEach((colour, k) => {
    if (colour) gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + k, gl.TEXTURE_2D, colour, 0);
  });
  gl.drawBuffers(colours.map((colour, k) => (colour ? gl.COLOR_ATTACHMENT0 + k : gl.NONE)));
  return made;
}
