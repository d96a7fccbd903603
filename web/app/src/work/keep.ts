// What stays in this browser until it is forgotten: files by their path in IndexedDB, which pages of files have too.

const name = "flightwatt";
const files = "files";

function asked<T>(request: IDBRequest<T>): Promise<T> {
  return new Promise((done, fail) => {
    request.onsuccess = () => done(request.result);
    request.onerror = () => fail(request.error);
  });
}

async function open(): Promise<IDBDatabase> {
  const request = indexedDB.open(name, 1);
  request.onupgradeneeded = () => request.result.createObjectStore(files);
  return asked(request);
}

async function inStore(mode: IDBTransactionMode, use: (store: IDBObjectStore) => void): Promise<void> {
  const database = await open();
  try {
    const transaction = database.transaction(files, mode);
    use(transaction.objectStore(files));
    await new Promise<void>((done, fail) => {
      transaction.oncomplete = () => done();
      transaction.onerror = transaction.onabort = () => fail(transaction.error);
    });
  } finally {
    database.close();
  }
}

/// Keeps files, and drops those of `gone`.
export function keep(kept: Map<string, Blob>, gone: string[] = []): Promise<void> {
  return inStore("readwrite", (store) => {
    for (const path of gone) store.delete(path);
    for (const [path, data] of kept) store.put(data, path);
  });
}

/// Returns all that is kept; nothing where the browser keeps nothing, as in a private window.
export async function kept(): Promise<Map<string, Blob>> {
  try {
    const database = await open();
    const store = database.transaction(files, "readonly").objectStore(files);
    const [paths, blobs] = await Promise.all([asked(store.getAllKeys()), asked(store.getAll())]);
    database.close();
    return new Map(paths.map((path, i) => [String(path), blobs[i] as Blob]));
  } catch {
    return new Map();
  }
}

/// Forgets everything.
export function forget(): Promise<void> {
  return inStore("readwrite", (store) => store.clear());
}
