#!/usr/bin/env node
// A small static server to look at terrain: node serve.js OUT [PORT]
//
//   /             the page beside this file
//   /cesium/...   CesiumJS, from node_modules (npm install puts it there)
//   /terrain/...  OUT/terrain, what `scree build -o OUT` wrote
//
// It shows the one thing that any static server has to do for terrain: a tile that is gzip'd (its first bytes say so)
// is sent with Content-Encoding: gzip. It listens on this machine only and is no server for the Internet.
'use strict';
const fs = require('node:fs');
const http = require('node:http');
const path = require('node:path');

const types = {
  '.css': 'text/css',
  '.gif': 'image/gif',
  '.html': 'text/html; charset=utf-8',
  '.jpg': 'image/jpeg',
  '.js': 'text/javascript',
  '.json': 'application/json',
  '.png': 'image/png',
  '.svg': 'image/svg+xml',
  '.terrain': 'application/vnd.quantized-mesh',
  '.wasm': 'application/wasm',
};

// The file that a request's path names, or null: only names below one of the roots, whatever the path says.
function resolve(roots, url) {
  let name;
  try {
    name = decodeURIComponent(new URL(url, 'http://localhost').pathname);
  } catch {
    return null;
  }
  if (name.includes('\0')) return null;
  if (name === '/') return roots.page;
  for (const [prefix, root] of [['/cesium/', roots.cesium], ['/terrain/', roots.terrain]]) {
    if (!name.startsWith(prefix)) continue;
    const file = path.resolve(root, '.' + path.sep + name.slice(prefix.length));
    return file.startsWith(path.resolve(root) + path.sep) ? file : null;
  }
  return null;
}

function headersFor(file, bytes) {
  const headers = {
    'Content-Type': types[path.extname(file)] || 'application/octet-stream',
    'Content-Length': bytes.length,
    'Access-Control-Allow-Origin': '*',
  };
  if (bytes.length > 2 && bytes[0] === 0x1f && bytes[1] === 0x8b) headers['Content-Encoding'] = 'gzip';
  return headers;
}

// Starts to serve; the promise gives the http.Server. Port 0: any free one. onRequest(path, status): for a log.
function serve({ terrain, cesium, port = 0, onRequest = () => {} }) {
  const roots = { page: path.join(__dirname, 'index.html'), cesium, terrain };
  const server = http.createServer((request, response) => {
    const finish = (status, headers, bytes) => {
      onRequest(request.url, status);
      response.writeHead(status, headers);
      response.end(request.method === 'HEAD' ? undefined : bytes);
    };
    if (request.method !== 'GET' && request.method !== 'HEAD') return finish(405, { Allow: 'GET, HEAD' });
    const file = resolve(roots, request.url);
    if (file === null) return finish(404, {});
    fs.readFile(file, (error, bytes) => (error ? finish(404, {}) : finish(200, headersFor(file, bytes), bytes)));
  });
  return new Promise((done, failed) => {
    server.once('error', failed);
    server.listen(port, '127.0.0.1', () => done(server));
  });
}

async function main() {
  const [out, port = '8080'] = process.argv.slice(2);
  if (out === undefined || !/^\d{1,5}$/.test(port)) {
    console.error('Usage: node serve.js OUT [PORT]   (OUT: the folder that scree build wrote)');
    return 2;
  }
  const terrain = path.join(out, 'terrain');
  const cesium = path.join(__dirname, 'node_modules', 'cesium', 'Build', 'Cesium');
  if (!fs.existsSync(path.join(terrain, 'layer.json'))) {
    console.error(`serve.js: ${terrain} has no layer.json; make it with: scree build DEM -o ${out}`);
    return 1;
  }
  if (!fs.existsSync(path.join(cesium, 'Cesium.js'))) {
    console.error(`serve.js: CesiumJS is not installed; run npm install in ${__dirname}`);
    return 1;
  }
  try {
    const server = await serve({ terrain, cesium, port: Number(port) });
    console.log(`http://127.0.0.1:${server.address().port}/   (Ctrl-C ends it)`);
    return 0;
  } catch (error) {
    console.error(`serve.js: cannot listen on port ${port}: ${error.message}`);
    return 1;
  }
}

module.exports = { serve };
if (require.main === module) main().then((code) => (process.exitCode = code));
