// The tree of files in memory that the program reads and writes: what the WASI shim has for that, where it is too slow or
// not enough. Its files copy themselves whole at each write, and its folders read themselves whole for each name.
import { Directory, Fd, Inode, OpenDirectory, wasi } from "@bjorn3/browser_wasi_shim";
import { partsOf } from "./paths";

/// Bytes that are read when they are asked for, as of a log on the user's disk.
export interface Source {
  readonly size: number;
  read(from: number, to: number): Uint8Array;
}

const askedAtMost = 1 << 22;  // a longer read is served in parts, each a copy of its own

/// As the shim's, which writes its times to wrong places.
class Status extends wasi.Filestat {
  override write_bytes(view: DataView, at: number): void {
    view.setBigUint64(at, this.dev, true);
    view.setBigUint64(at + 8, this.ino, true);
    view.setUint8(at + 16, this.filetype);
    [this.nlink, this.size, this.atim, this.mtim, this.ctim].forEach(
      (value, i) => view.setBigUint64(at + 24 + 8 * i, value, true));
  }
}

export class StoredFile extends Inode {
  /// Whether a run wrote to it since this was cleared.
  isChanged = false;
  modifiedMs = 0;
  private source: Source | null = null;
  private buffer: Uint8Array = new Uint8Array(0);
  private length = 0;

  constructor(content: Source | Uint8Array | null = null, modifiedMs = Date.now()) {
    super();
    this.modifiedMs = modifiedMs;
    if (content instanceof Uint8Array) {
      this.buffer = content;
      this.length = content.length;
    } else {
      this.source = content;
    }
  }

  get size(): number { return this.source ? this.source.size : this.length; }

  bytes(): Uint8Array { return this.read(0, this.size); }

  /// A view where the bytes are in memory.
  read(from: number, to: number): Uint8Array {
    const end = Math.min(to, this.size);
    if (from >= end) return new Uint8Array(0);
    return this.source ? this.source.read(from, end) : this.buffer.subarray(from, end);
  }

  write(data: Uint8Array, at: number): void {
    this.resize(Math.max(this.size, at + data.length));
    this.buffer.set(data, at);
  }

  resize(size: number): void {
    this.isChanged = true;
    this.modifiedMs = Date.now();
    if (this.source) {
      this.buffer = size > 0 ? this.source.read(0, this.source.size).slice() : new Uint8Array(0);
      this.length = this.buffer.length;
      this.source = null;
    }
    if (size > this.buffer.length) {
      const grown = new Uint8Array(Math.max(size, 2 * this.buffer.length));
      grown.set(this.buffer.subarray(0, this.length));
      this.buffer = grown;
    } else if (size < this.length) {
      this.buffer.fill(0, size, this.length);
    }
    this.length = size;
  }

  path_open(oflags: number, _rights: bigint, fd_flags: number) {
    if (oflags & wasi.OFLAGS_TRUNC) this.resize(0);
    return { ret: wasi.ERRNO_SUCCESS, fd_obj: new OpenStoredFile(this, (fd_flags & wasi.FDFLAGS_APPEND) !== 0) };
  }

  stat(): wasi.Filestat {
    const status = new Status(this.ino, wasi.FILETYPE_REGULAR_FILE, BigInt(this.size));
    status.nlink = 1n;
    status.mtim = status.ctim = status.atim = BigInt(Math.round(this.modifiedMs)) * 1000000n;
    return status;
  }
}

export class OpenStoredFile extends Fd {
  private at = 0;

  constructor(readonly file: StoredFile, private readonly appends = false) { super(); }

  override fd_fdstat_get() {
    const fdstat = new wasi.Fdstat(wasi.FILETYPE_REGULAR_FILE, this.appends ? wasi.FDFLAGS_APPEND : 0);
    fdstat.fs_rights_base = fdstat.fs_rights_inherited = ~0n & 0xffffffffffffffffn;
    return { ret: wasi.ERRNO_SUCCESS, fdstat };
  }
  override fd_fdstat_set_flags() { return wasi.ERRNO_SUCCESS; }
  override fd_filestat_get() { return { ret: wasi.ERRNO_SUCCESS, filestat: this.file.stat() }; }
  override fd_filestat_set_size(size: bigint) {
    this.file.resize(Number(size));
    return wasi.ERRNO_SUCCESS;
  }
  override fd_allocate(offset: bigint, length: bigint) {
    if (Number(offset + length) > this.file.size) this.file.resize(Number(offset + length));
    return wasi.ERRNO_SUCCESS;
  }
  override fd_filestat_set_times() { return wasi.ERRNO_SUCCESS; }
  override fd_read(size: number) {
    const answer = this.fd_pread(size, BigInt(this.at));
    this.at += answer.data.length;
    return answer;
  }
  override fd_pread(size: number, offset: bigint) {
    const from = Number(offset);
    try {
      return { ret: wasi.ERRNO_SUCCESS, data: this.file.read(from, from + Math.min(size, askedAtMost)) };
    } catch {
      return { ret: wasi.ERRNO_IO, data: new Uint8Array(0) };  // a file of the user's that was changed or removed
    }
  }
  override fd_write(data: Uint8Array) {
    if (this.appends) this.at = this.file.size;
    this.file.write(data, this.at);
    this.at += data.length;
    return { ret: wasi.ERRNO_SUCCESS, nwritten: data.length };
  }
  override fd_pwrite(data: Uint8Array, offset: bigint) {
    this.file.write(data, Number(offset));
    return { ret: wasi.ERRNO_SUCCESS, nwritten: data.length };
  }
  override fd_seek(offset: bigint, whence: number) {
    const base = whence === wasi.WHENCE_SET ? 0 : whence === wasi.WHENCE_CUR ? this.at : this.file.size;
    const at = base + Number(offset);
    if (at < 0) return { ret: wasi.ERRNO_INVAL, offset: 0n };
    this.at = at;
    return { ret: wasi.ERRNO_SUCCESS, offset: BigInt(at) };
  }
  override fd_tell() { return { ret: wasi.ERRNO_SUCCESS, offset: BigInt(this.at) }; }
}

class OpenFolder extends OpenDirectory {
  private names: [string, Inode][] | null = null;

  override fd_fdstat_get() {
    const fdstat = new wasi.Fdstat(wasi.FILETYPE_DIRECTORY, 0);
    fdstat.fs_rights_base = fdstat.fs_rights_inherited = 0xffffffffffffffffn;  // for which faccessat asks
    return { ret: wasi.ERRNO_SUCCESS, fdstat };
  }
  override fd_fdstat_set_flags() { return wasi.ERRNO_SUCCESS; }
  /// As of when the reading began.
  override fd_readdir_single(cookie: bigint) {
    if (cookie < 2n) this.names = null;
    if (cookie < 2n) return super.fd_readdir_single(cookie);
    this.names ??= [...this.dir.contents];
    const found = this.names[Number(cookie) - 2];
    if (!found) return { ret: wasi.ERRNO_SUCCESS, dirent: null };
    const [name, entry] = found;
    const type = entry instanceof Folder ? wasi.FILETYPE_DIRECTORY : wasi.FILETYPE_REGULAR_FILE;
    return { ret: wasi.ERRNO_SUCCESS, dirent: new wasi.Dirent(cookie + 1n, entry.ino, name, type) };
  }
}

export class Folder extends Directory {
  constructor() { super(new Map()); }

  override path_open() { return { ret: wasi.ERRNO_SUCCESS, fd_obj: new OpenFolder(this) }; }

  override create_entry_for_path(path: string, isFolder: boolean) {
    const made = super.create_entry_for_path(path, true);  // a folder of the shim's, replaced by one of these
    if (made.entry === null) return made;
    const parts = path.split("/").filter((part) => part !== "" && part !== ".");
    const parent = this.folderOf(parts);
    const entry = isFolder ? new Folder() : new StoredFile();
    if (entry instanceof StoredFile) entry.isChanged = true;
    parent?.contents.set(parts[parts.length - 1]!, entry);
    return { ret: made.ret, entry };
  }

  private folderOf(parts: string[]): Folder | null {
    let at: Folder = this;
    for (const part of parts.slice(0, -1)) {
      const next = at.contents.get(part);
      if (!(next instanceof Folder)) return null;
      at = next;
    }
    return at;
  }
}

/// The root of the tree, as the program opens it.
export class OpenRoot extends OpenFolder {
  constructor(root: Folder) { super(root); }
  override fd_prestat_get() { return { ret: wasi.ERRNO_SUCCESS, prestat: wasi.Prestat.dir("/") }; }
}

/// Puts a file into the tree and makes its folders; a file in the way of a folder is replaced.
export function put(root: Folder, path: string, file: StoredFile): void {
  const parts = partsOf(path);
  const name = parts.pop();
  if (name === undefined) throw new Error(`'${path}' names no file`);
  let at = root;
  for (const part of parts) {
    let next = at.contents.get(part);
    if (!(next instanceof Folder)) at.contents.set(part, next = new Folder());
    at = next as Folder;
  }
  at.contents.set(name, file);
}

/// Removes a file, or a folder with what is in it; where neither is there, nothing.
export function remove(root: Folder, path: string): void {
  const parts = partsOf(path);
  const name = parts.pop();
  let at: Inode | undefined = root;
  for (const part of parts) at = at instanceof Folder ? at.contents.get(part) : undefined;
  if (name === undefined) root.contents.clear();
  else if (at instanceof Folder) at.contents.delete(name);
}

/// All files by path.
export function files(root: Folder): Map<string, StoredFile> {
  const found = new Map<string, StoredFile>();
  const walk = (folder: Folder, path: string) => {
    for (const [name, entry] of folder.contents) {
      if (entry instanceof Folder) walk(entry, `${path}/${name}`);
      else if (entry instanceof StoredFile) found.set(`${path}/${name}`, entry);
    }
  };
  walk(root, "");
  return found;
}
