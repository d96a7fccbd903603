// For esbuild: an import "worker:./FILE.ts" is the text of FILE.ts, bundled into one script for a worker.
import { build } from "esbuild";
import path from "node:path";

export const workerText = {
  name: "worker text",
  setup(setup) {
    setup.onResolve({ filter: /^worker:/ }, ({ path: name, resolveDir }) => ({
      path: path.resolve(resolveDir, name.slice("worker:".length)),
      namespace: "worker text",
    }));
    setup.onLoad({ filter: /.*/, namespace: "worker text" }, async ({ path: file }) => {
      const { minify, target, absWorkingDir } = setup.initialOptions;
      const { outputFiles, metafile } = await build({
        entryPoints: [file], bundle: true, write: false, format: "iife", metafile: true, minify, target, absWorkingDir,
      });
      const watched = Object.keys(metafile.inputs).map((name) => path.resolve(absWorkingDir ?? ".", name));
      return { contents: outputFiles[0].text, loader: "text", watchFiles: watched };
    });
  },
};
