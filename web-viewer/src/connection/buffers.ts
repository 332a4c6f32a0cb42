const most = 4;

/** Buffers of states that the page has given back, so that a frame takes no new memory. */
export class Buffers {
  private readonly spare: ArrayBuffer[] = [];

  /** At least this many bytes, which hold anything. */
  take(bytes: number): ArrayBuffer {
    const used = this.spare.pop();
    return used && used.byteLength >= bytes ? used : new ArrayBuffer(bytes);
  }

  giveBack(buffer: ArrayBuffer): void {
    if (this.spare.length < most) this.spare.push(buffer);
  }
}
