// Paths of the tree of files. All are absolute: the program runs in "/".

/// "/a/./b/../c" and "a/c" are ["a", "c"].
export function partsOf(path: string): string[] {
  const parts: string[] = [];
  for (const part of path.split("/")) {
    if (part === "..") parts.pop();
    else if (part !== "" && part !== ".") parts.push(part);
  }
  return parts;
}

/// "/a/c": as list() names it.
export function normalized(path: string): string { return "/" + partsOf(path).join("/"); }
