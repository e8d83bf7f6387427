// Terrain made by scree in CesiumJS, in a headless Chromium, on loopback alone:
//   - sampleTerrainMostDetailed gives the elevation model's heights at posts of the finest zoom, within the tolerance
//     that layer.json promises for it,
//   - tiles of several zooms are drawn,
//   - the console shows no error and no request fails.
// Usage: node terrain.js DEM WORK SERVE_JS; WORK holds terrain/ and receives the pictures; NODE_PATH has the modules.
'use strict';
const assert = require('node:assert/strict');
const { execFileSync } = require('node:child_process');
const fs = require('node:fs');
const os = require('node:os');
const path = require('node:path');
const { chromium } = require('playwright-core');

const [dem, work, serveJs] = process.argv.slice(2);
const { serve } = require(path.resolve(serveJs));

const TILE_CELLS = 256;
const POINTS = 16;

// The elevation model, read through GDAL's own programs and not through scree.
function readModel() {
  const info = JSON.parse(execFileSync('gdalinfo', ['-json', dem], { encoding: 'utf8' }));
  const [columns, rows] = info.size;
  const raw = path.join(work, 'dem.raw');
  execFileSync('gdal_translate', ['-q', '-of', 'ENVI', '-ot', 'Float32', dem, raw]);
  const bytes = fs.readFileSync(raw);
  const heights_m = new Float32Array(bytes.buffer, bytes.byteOffset, columns * rows);
  const [west, dx, , north, , dy] = info.geoTransform;
  const at = (longitude, latitude) => {
    const x = (longitude - west) / dx - 0.5;
    const y = (latitude - north) / dy - 0.5;
    const i = Math.floor(x), j = Math.floor(y);
    const four = [0, 1, columns, columns + 1].map((step) => heights_m[j * columns + i + step]);
    const u = x - i, v = y - j;
    return {
      height_m: (1 - v) * ((1 - u) * four[0] + u * four[1]) + v * ((1 - u) * four[2] + u * four[3]),
      relief_m: Math.max(...four) - Math.min(...four),
    };
  };
  return { at, west, north, east: west + columns * dx, south: north + rows * dy };
}

// Heights above the EGM96 geoid as heights above the ellipsoid, by PROJ through gdaltransform.
function aboveEllipsoid(points) {
  const lines = points.map((p) => `${p.longitude} ${p.latitude} ${p.height_m}`).join('\n');
  const output = execFileSync('gdaltransform', ['-s_srs', 'EPSG:4326+5773', '-t_srs', 'EPSG:4979'],
    { input: lines + '\n', encoding: 'utf8' });
  return output.trim().split('\n').map((line) => Number(line.split(/\s+/)[2]));
}

// Posts of the finest zoom, well inside the model and spread over it.
function choosePoints(model, finestZoom) {
  const spacing = 180 / TILE_CELLS / 2 ** finestZoom;
  const post = (fraction, from, to, origin) =>
    origin + spacing * Math.round((from + fraction * (to - from) - origin) / spacing);
  return Array.from({ length: POINTS }, (_, i) => {
    const longitude = post(0.05 + 0.9 * ((i * 7 + 3) % POINTS) / POINTS, model.west, model.east, -180);
    const latitude = post(0.05 + 0.9 * (i / POINTS), model.south, model.north, -90);
    return { longitude, latitude, ...model.at(longitude, latitude) };
  });
}

async function checkHeights(page, layer) {
  const zoom = layer.maxzoom;
  const promise = layer.scree.zooms.find((entry) => entry.zoom === zoom);
  assert.ok(promise, `layer.json tells nothing about its finest zoom ${zoom}`);
  const points = choosePoints(readModel(), zoom);
  const expected = aboveEllipsoid(points);
  const found = await page.evaluate(async (places) => {
    const { terrainProvider } = await window.scree;
    const cartographics = places.map((p) => Cesium.Cartographic.fromDegrees(p.longitude, p.latitude));
    await Cesium.sampleTerrainMostDetailed(terrainProvider, cartographics);
    return cartographics.map((c) => c.height);
  }, points);
  let worst_m = 0;
  points.forEach((point, i) => {
    // Beyond the tolerance: heights are rounded to steps, positions to a 32767th of the tile.
    const allowed_m = promise.tolerance_m + promise.height_step_m + point.relief_m * TILE_CELLS / 32767;
    const error_m = Math.abs(found[i] - expected[i]);
    worst_m = Math.max(worst_m, error_m);
    assert.ok(error_m <= allowed_m, `at ${point.longitude}, ${point.latitude}: Cesium says ${found[i]} m, ` +
      `the model ${expected[i]} m above the ellipsoid; that is ${error_m} m apart, ${allowed_m} m are allowed`);
  });
  console.log(`heights: ${points.length} points, worst error ${worst_m.toFixed(2)} m, ` +
    `tolerance of zoom ${zoom}: ${promise.tolerance_m} m`);
}

// Draws from a distance of `spans` times the model's height and returns the zooms of the tiles on the screen.
async function draw(page, spans, picture) {
  const { zooms, isInMiddle } = await page.evaluate(async (distance) => {
    const { viewer, rectangle, height_m } = await window.scree;
    const globe = viewer.scene.globe;
    look(viewer, rectangle, height_m, distance);
    for (let quiet = 0; quiet < 3;) {
      await new Promise((next) => setTimeout(next, 100));
      viewer.render();
      quiet = globe.tilesLoaded ? quiet + 1 : 0;
    }
    const canvas = viewer.scene.canvas;
    const middle = new Cesium.Cartesian2(canvas.clientWidth / 2, canvas.clientHeight / 2);
    const hit = globe.pick(viewer.camera.getPickRay(middle), viewer.scene);
    return {
      zooms: globe._surface._tilesToRender.map((tile) => tile.level),
      isInMiddle: hit !== undefined && Cesium.Rectangle.contains(rectangle, Cesium.Cartographic.fromCartesian(hit)),
    };
  }, spans);
  if (picture) await page.screenshot({ path: path.join(work, picture) });
  assert.ok(isInMiddle, `from ${spans} spans away the terrain is not in the middle of the screen`);
  return zooms;
}

async function checkDrawing(page, layer) {
  // Tiles of one zoom need no skirts to hide cracks, and pictures are nicer without.
  await page.evaluate(async () => void ((await window.scree).viewer.scene.globe.showSkirts = false));
  const counts = new Map();
  for (const [spans, picture] of [[400, undefined], [20, undefined], [1.45, 'oblique.png'], [0.6, 'near.png']])
    for (const zoom of await draw(page, spans, picture)) counts.set(zoom, (counts.get(zoom) || 0) + 1);
  const zooms = [...counts.keys()].sort((a, b) => a - b);
  console.log(`drawn: ${zooms.map((zoom) => `${counts.get(zoom)} tiles of zoom ${zoom}`).join(', ')}`);
  assert.ok(zooms.length >= 3, 'tiles of at least three zooms should have been drawn');
  assert.ok(zooms.includes(layer.maxzoom), `no tile of the finest zoom ${layer.maxzoom} was drawn`);
}

async function main() {
  const terrain = path.join(work, 'terrain');
  const layer = JSON.parse(fs.readFileSync(path.join(terrain, 'layer.json'), 'utf8'));
  const refused = [];
  const server = await serve({
    terrain,
    cesium: path.join(work, 'node_modules', 'cesium', 'Build', 'Cesium'),
    onRequest: (url, status) => status === 200 || refused.push(`${status} ${url}`),
  });
  const profile = fs.mkdtempSync(path.join(os.tmpdir(), 'scree-cesium-'));
  const browser = await chromium.launchPersistentContext(profile, {
    executablePath: '/usr/bin/chromium',
    viewport: { width: 1280, height: 720 },
    args: ['--headless', '--no-sandbox', '--disable-gpu', '--use-gl=angle', '--use-angle=swiftshader',
      '--enable-unsafe-swiftshader', '--disable-quic', '--no-first-run', '--disable-background-networking',
      '--disable-component-update', '--disable-sync'],
  });
  const complaints = [];
  try {
    const page = await browser.newPage();
    page.setDefaultTimeout(240000);
    page.on('console', (message) => message.type() === 'error' && complaints.push(message.text()));
    page.on('pageerror', (error) => complaints.push(String(error)));
    page.on('requestfailed', (request) => complaints.push(`${request.url()}: ${request.failure().errorText}`));
    await page.goto(`http://127.0.0.1:${server.address().port}/`);
    await page.evaluate(async () => void (await window.scree));
    await checkHeights(page, layer);
    await checkDrawing(page, layer);
    assert.deepEqual(refused, [], 'the server had no answer for some requests');
    assert.deepEqual(complaints, [], 'the browser complained');
  } catch (error) {
    if (complaints.length > 0) console.error(`the browser's console: ${complaints.join('\n')}`);
    throw error;
  } finally {
    await browser.close();
    server.close();
    fs.rmSync(profile, { recursive: true, force: true });
  }
}

main().then(
  () => console.log('check-cesium: passed'),
  (error) => {
    console.error(`check-cesium: FAILED: ${error.message}`);
    process.exit(1);
  });
