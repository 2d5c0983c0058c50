// validate_glb.js PACKAGE FILE: what gltf-validator, whose folder PACKAGE is, says of a GLB file: a line for
// each error and warning.
const fs = require("fs");
const [, , folder, file] = process.argv;
require(folder)
  .validateBytes(new Uint8Array(fs.readFileSync(file)), { maxIssues: 20 })
  .then(({ issues }) => {
    const ERROR = 0, WARNING = 1;
    for (const { severity, code, message, pointer } of issues.messages) {
      if (severity === ERROR || severity === WARNING) console.log(`${code} ${pointer}: ${message}`);
    }
  });
