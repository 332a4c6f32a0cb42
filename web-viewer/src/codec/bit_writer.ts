/** Writes units of 16 bits and fields of bits, least significant bit first. */
export class BitWriter {
  private bytes = new Uint8Array(4096);
  private view = new DataView(this.bytes.buffer);
  private pending = 0; // bits that belong to the next bytes
  private count = 0; // of pending bits, below 8
  end = 0; // bytes

  clear(): void {
    this.end = this.count = this.pending = 0;
  }

  /** Makes room for this many bytes. */
  reserve(more: number): void {
    if (this.bytes.length >= this.end + more) return;
    const longer = new Uint8Array(2 * (this.end + more));
    longer.set(this.bytes);
    this.bytes = longer;
    this.view = new DataView(longer.buffer);
  }

  /** `width`: 0 to 32 bits. There must be room for 8 bytes. */
  field(value: number, width: number): void {
    if (width > 16) {
      this.field(value & 0xffff, 16);
      this.field(value >>> 16, width - 16);
      return;
    }
    this.pending |= (value & ((1 << width) - 1)) << this.count;
    this.count += width;
    while (this.count >= 8) {
      this.bytes[this.end++] = this.pending;
      this.pending >>>= 8;
      this.count -= 8;
    }
  }

  unit(value: number): void {
    this.view.setUint16(this.end, value, true);
    this.end += 2;
  }

  word(value: number): void {
    this.setWord(this.end, value);
    this.end += 4;
  }

  /** `at`: a byte that has been written. */
  setWord(at: number, value: number): void {
    this.view.setUint32(at, value, true);
  }

  /** Ends the last field, and adds zero bits up to a multiple of this many bytes. */
  align(bytes: number): void {
    if (this.count > 0) this.field(0, 8 - this.count);
    while (this.end % bytes !== 0) this.bytes[this.end++] = 0;
  }

  written(): Uint8Array<ArrayBuffer> {
    return this.bytes.slice(0, this.end);
  }
}
