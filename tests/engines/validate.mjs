// Runs the Khronos glTF validator over files: prints one JSON object a line, {file, errors, warnings, messages}.
import fs from "node:fs";
import { createRequire } from "node:module";

const require = createRequire(new URL("../node_modules/", import.meta.url));
const validator = require("gltf-validator");

// Tangents are left out on purpose: glTF 2.0 (3.7.2.1) has readers make them, and they would be a fifth of each vertex.
const severityOverrides = { MESH_PRIMITIVE_GENERATED_TANGENT_SPACE: 2 };

for (const file of process.argv.slice(2)) {
  const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), { maxIssues: 50, severityOverrides });
  const { numErrors, numWarnings, messages } = report.issues;
  const words = messages.filter((m) => m.severity < 2).map((m) => `${m.code} ${m.pointer}: ${m.message}`);
  console.log(JSON.stringify({ file, errors: numErrors, warnings: numWarnings, messages: words }));
}
