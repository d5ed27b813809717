// node mcp_client.mjs CALLS.json COMMAND ...: a client of the Model Context Protocol that is not ours starts a server, lists its tools and
// calls some. CALLS: [[name, arguments], ...]. Prints a line of JSON.
import fs from "node:fs";
import { Client } from "@modelcontextprotocol/sdk/client/index.js";
import { StdioClientTransport } from "@modelcontextprotocol/sdk/client/stdio.js";

const [calls, command, ...args] = process.argv.slice(2);
const client = new Client({ name: "stranger", version: "1" });
await client.connect(new StdioClientTransport({ command, args }));
try {
  const { tools } = await client.listTools();
  const results = [];
  for (const [name, given] of JSON.parse(fs.readFileSync(calls))) {
    const { isError, structuredContent, content } = await client.callTool({ name, arguments: given });
    results.push({ isError, told: structuredContent, same: content[0].text === JSON.stringify(structuredContent) });
  }
  await client.ping();
  const { name } = client.getServerVersion();
  console.log(JSON.stringify({ tools: tools.map((tool) => tool.name), results, name, instructions: client.getInstructions() }));
} finally {
  await client.close();
}
