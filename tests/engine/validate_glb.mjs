// Runs Khronos' validator over the GLB files named on the command line; prints one JSON report each.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

const require = createRequire(new URL("../../static/package.json", import.meta.url));
const validator = require("gltf-validator");

for (const path of process.argv.slice(2)) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(path)), {
    maxIssues: 100,
  });
  console.log(JSON.stringify({ path, ...report.issues }));
}
