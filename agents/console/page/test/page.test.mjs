// The page as people use it: what it shows, and goals.
import assert from 'node:assert/strict';
import {readFileSync, rmSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join} from 'node:path';
import {test} from 'node:test';
import {address, fact, folder, leave, moves, open, person, robot, send, stands} from './browser.mjs';
import {end, sleep, start, until} from './processes.mjs';

const axeSource = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

const openGoals = page => page.getByRole('list', {name: 'Goals', exact: true}).locator('.card');
const endedGoals = page => page.getByRole('list', {name: 'Ended goals'}).locator('.card');
async function endAll(page) {
  await page.getByRole('button', {name: 'End all'}).click();
  await until('the end of every goal', async () => await openGoals(page).count() === 0);
}
// A place right of the robot.
async function choosePlace(page) {
  const box = await page.locator('canvas').boundingBox();
  await page.mouse.click(box.x + box.width / 2 + 60, box.y + box.height / 2);
  await page.getByRole('dialog').waitFor();
}
// How many pixels of the picture each color has.
async function colorsOf(page, selector = 'canvas') {
  return new Map(await page.evaluate(selector => {
    const canvas = document.querySelector(selector), count = new Map();
    for (const color of new Uint32Array(canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.buffer))
      count.set(color, (count.get(color) ?? 0) + 1);
    const [r, g, b] = [0, 8, 16].map(shift => color => (color >> shift & 255).toString(16).padStart(2, '0'));
    return [...count].map(([color, pixels]) => [`#${r(color)}${g(color)}${b(color)}`, pixels]);
  }, selector));
}
// From now on the page hears these topics with other members, and so much older [ms]; of a cycle: by so many later.
const hears = (page, topics, age = 0) => page.evaluate(([topics, age]) => {
  const get = saphira.get.bind(saphira);
  saphira.get = (topic, key) => {
    const item = get(topic, key), {cycle = 0, ...members} = topics[topic] ?? {};
    if (!item || !topics[topic]) return item;
    return {at: item.at - age, data: {...item.data, ...members, ...(cycle && {cycle: item.data.cycle + cycle})}};
  };
}, [topics, age]);

test('shows the robot, on a map, soon', async () => {
  const page = await person();
  await open(page);
  assert.equal(new URL(page.url()).hash, '', 'the key does not stay in the address');
  await until('the place on the map', async () => page.locator('dt:text-is("On the map")').count());
  assert.match(await fact(page, 'Battery'), /^\d+\.\d V$/);
  assert.match(await fact(page, 'On the map'), /m, \d+° ± .* c?m, \d+% sure$/);
  const colors = await colorsOf(page), robotColor = '#1a5fb4';
  assert.ok(colors.size > 5, `${colors.size} colors are on the canvas`);
  assert.ok(colors.get(robotColor) > 20, `${colors.get(robotColor)} pixels of the robot`);
  // A lost robot is drawn, and told, as a guess.
  await hears(page, {registration: {state: 'REGISTRATION_LOST', confidence: 0, reason: 'nothing fits'}});
  await page.getByText('The robot does not know where it is (nothing fits). Click where it is on the map').waitFor();
  assert.match(await fact(page, 'Lost, at a guess'), / m, \d+°, 0% sure$/);
  await until('a robot that is not filled', async () => !(await colorsOf(page)).has(robotColor));
  await leave(page);
});

test('the camera is shown, and it is off while nobody looks', async () => {
  const page = await person();
  await open(page);
  const state = () => page.evaluate(() => saphira.all('system/status').find(([, {data}]) => data.name === 'camera')?.[1].data.reason);
  await until('a camera that is off', async () => await state() === 'off: nobody looks');
  await page.getByRole('button', {name: 'Camera', exact: true}).click();
  await page.locator('.camera figcaption').getByText(/^\d\.\d s old$/).waitFor();
  const colors = await colorsOf(page, '.camera canvas');
  assert.ok(colors.size > 500, `${colors.size} colors are in the picture`);
  assert.equal(await state(), '');
  await page.getByRole('button', {name: 'Close the camera'}).click();
  await until('a camera that is off', async () => await state() === 'off: nobody looks');
  await leave(page);
});

test('it is an app that a browser installs, and shows at its next start what it showed', async () => {
  const page = await person();
  await open(page);
  // What Chromium misses for that: nothing but a profile that stays.
  const devtools = await page.context().newCDPSession(page);
  const {installabilityErrors} = await devtools.send('Page.getInstallabilityErrors');
  assert.deepEqual(installabilityErrors.map(({errorId}) => errorId), ['in-incognito']);
  await page.getByRole('tab', {name: 'Programs'}).click();
  await page.reload();
  await page.locator('.link.live').waitFor();
  assert.equal(await page.getByRole('tab', {name: 'Programs'}).getAttribute('aria-selected'), 'true');
  await leave(page);
});

test('old news are told with their age', async () => {
  const page = await person();
  await open(page);
  await send(page, 'drive 0.05');
  const card = openGoals(page).first();
  await card.getByText('underway').waitFor();
  assert.doesNotMatch(await page.locator('.sentence').innerText(), / ago: /);
  assert.equal(await card.getByText(/ ago$/).count(), 0);
  await hears(page, {'goals/status': {}, why: {cycle: -50}}, 5000);
  await card.getByText(/^[5-7]\.\d s ago$/).waitFor();
  await page.locator('.sentence').getByText(/^[5-7]\.\d s ago: /).waitFor();
  await endAll(page);
  await leave(page);
});

test('without a connection nothing is said of goals and programs', async () => {
  const page = await person();
  await open(page);
  await page.getByRole('tab', {name: 'Intentions'}).click();
  const idle = page.getByText('The robot intends nothing');
  await idle.waitFor();
  await page.evaluate(() => Object.defineProperty(saphira, 'connected', {get: () => false, set() {}}));
  await page.getByText('Not known: there is no connection to the console.').waitFor();
  assert.equal(await idle.count(), 0);
  await leave(page);
});

for (const [name, options] of [['light', {colorScheme: 'light'}], ['dark', {colorScheme: 'dark'}],
                               ['a telephone', {viewport: {width: 320, height: 640}, hasTouch: true, isMobile: true}]])
  test(`axe finds nothing, and nothing is cut off: ${name}`, async () => {
    const page = await person({...options, bypassCSP: true});
    await open(page);
    await page.addScriptTag({content: axeSource});
    for (const tab of ['Goals', 'Why', 'Behaviors', 'Intentions', 'Programs', 'Messages']) {
      await page.getByRole('tab', {name: tab}).click();
      // The dark page has other colors, and else nothing of its own.
      const {violations} = await page.evaluate(dark => window.axe.run(dark ? {runOnly: ['color-contrast']} : {}), name === 'dark');
      assert.deepEqual(violations.map(v => `${v.id}: ${v.nodes.map(n => n.html).join(' ')}`), [], tab);
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${tab} is wider than the window`);
    }
    if (options.isMobile) await page.getByText('Layers').click();
    await page.getByRole('link', {name: "the simulator's own view"}).waitFor();
    await leave(page);
  });

test('the legend opens and closes by mouse and by keyboard, and lists what is drawn', async () => {
  for (const options of [{}, {viewport: {width: 320, height: 640}, hasTouch: true, isMobile: true}]) {
    const page = await person({...options, bypassCSP: true});
    await open(page);
    const button = page.getByRole('button', {name: 'Legend'}), legend = page.getByRole('region', {name: 'Legend'});
    assert.equal(await button.getAttribute('aria-expanded'), 'false');
    assert.equal(await legend.count(), 0);
    await button.click();
    assert.equal(await button.getAttribute('aria-expanded'), 'true');
    for (const words of ['the robot and its nose', 'lost: the robot at a guess', 'the route', 'a goal', 'a sonar echo; larger: a new one', 'a person; with an arm: who points', 'a door that was closed', 'a zone to keep out of'])
      await legend.getByText(words, {exact: true}).waitFor();
    // Each line has its sign, in a colour of the map.
    assert.equal(await legend.locator('li').count(), await legend.locator('li svg > *').count());
    assert.ok(await legend.locator('li').count() >= 25);
    await page.addScriptTag({content: axeSource});
    const {violations} = await page.evaluate(() => window.axe.run());
    assert.deepEqual(violations.map(v => `${v.id}: ${v.nodes.map(n => n.html).join(' ')}`), []);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    await legend.focus();
    await page.keyboard.press('Escape');
    assert.equal(await legend.count(), 0);
    assert.ok(await button.evaluate(b => b === document.activeElement));
    await page.keyboard.press('Enter');
    await legend.waitFor();
    await page.keyboard.press('Escape');
    await until('it is closed', async () => await legend.count() === 0);
    // It covers none of the other buttons.
    const [box, layers] = [await button.boundingBox(), await page.locator('.layers').boundingBox()];
    assert.ok(box.x + box.width <= layers.x || box.y + box.height <= layers.y, JSON.stringify([box, layers]));
    await leave(page);
  }
});

test('a click sends the robot, with an answer and a cancel button', async () => {
  const page = await person();
  await open(page);
  await page.getByRole('button', {name: 'Follow'}).click();
  const box = await page.locator('canvas').boundingBox();
  await page.mouse.click(box.x + box.width / 2 + 90, box.y + box.height / 2);
  await page.getByRole('button', {name: 'Go here'}).click();
  const card = page.locator('.card:not(.over)', {hasText: 'go to'});
  await card.locator('.chip', {hasText: 'underway'}).waitFor();
  await moves(page);
  await card.getByRole('button', {name: 'Cancel'}).click();
  await page.locator('.card.over', {hasText: 'go to'}).waitFor();
  await stands(page);
  // A refused goal shows the reason: words that are no goal at once, and a place that the map does not have in its card.
  await send(page, 'go 3 nowhere');
  await page.locator('.told.bad').waitFor();
  await send(page, 'go nowhere at all');
  await endedGoals(page).filter({hasText: 'the map has no place "nowhere at all"'}).first().waitFor();
  await leave(page);
});

test('says what can be asked for', async () => {
  const page = await person();
  await open(page);
  for (const words of ['go N1', 'go corridor', 'go_to position=', 'patrol'])
    await page.locator(`#goal-wishes option[value="${words}"]`).waitFor({state: 'attached'});
  assert.equal(await page.getByLabel('Ask the robot for something').getAttribute('placeholder'), 'go lobby, turn to 90');
  await leave(page);
});

test('a place is chosen without a mouse, and left', async () => {
  const page = await person();
  await open(page);
  await page.getByRole('button', {name: 'Follow'}).click();
  await page.locator('canvas').focus();
  const dialog = page.getByRole('dialog', {name: 'A place on the map'});
  const choose = async () => { for (let i = 0; i < 4; ++i) await page.keyboard.press('Shift+ArrowRight'); };
  await choose();
  await dialog.waitFor();
  await page.keyboard.press('Enter');
  await page.keyboard.press('Escape');
  await dialog.waitFor({state: 'detached'});
  await choose();   // the picture has the keys again
  await page.keyboard.press('Enter');
  await page.keyboard.press('Enter');
  await openGoals(page).filter({hasText: 'go to'}).getByText('underway').waitFor();
  await moves(page);
  await endAll(page);
  await stands(page);
  await leave(page);
});

test('goals wait in their order, one goes instead of them, and an ended one is asked for again', async () => {
  const page = await person();
  await open(page);
  await page.getByRole('button', {name: 'Follow'}).click();
  await send(page, 'drive 0.05');
  const [first, second, third] = [0, 1, 2].map(i => openGoals(page).nth(i));
  await first.filter({hasText: 'drive'}).getByText('underway').waitFor();
  await send(page, 'turn to 90');
  await first.filter({hasText: '1. drive'}).getByText('in front').waitFor();
  await second.filter({hasText: '2. turn to'}).getByText('next').waitFor();
  await second.getByText('waits for "drive"').waitFor();
  await choosePlace(page);
  await page.getByText('1 more waits').waitFor();
  await page.getByRole('button', {name: 'Go here after that'}).click();
  await third.filter({hasText: '3. go to'}).getByText('waiting').waitFor();
  await choosePlace(page);
  await page.getByText('2 more wait').waitFor();
  await page.getByRole('button', {name: 'Go here instead'}).click();
  await first.filter({hasText: 'go to'}).getByText('underway').waitFor();
  for (const ended of ['drive', 'turn to', 'go to']) await endedGoals(page).filter({hasText: ended}).getByText('canceled').first().waitFor();
  await endAll(page);
  await page.getByRole('button', {name: 'Ask again: go to'}).first().click();
  await first.filter({hasText: 'go to'}).getByText('underway').waitFor();
  await endAll(page);
  await leave(page);
});

test('the card of a place does not cover it, and sets the position of the robot after a question only', async () => {
  for (const options of [{}, {viewport: {width: 390, height: 844}, hasTouch: true, isMobile: true}]) {
    const page = await person(options);
    await open(page);
    await page.locator('dt:text-is("On the map")').waitFor();
    const card = page.getByRole('dialog'), canvas = await page.locator('canvas').boundingBox();
    for (const x of [0.05, 0.5, 0.95])
      for (const y of [0.2, 0.5, 0.95]) {
        const at = {x: canvas.x + x * canvas.width, y: canvas.y + y * canvas.height};
        await page.mouse.click(at.x, at.y);
        await until(`the card beside ${x}, ${y}`, async () => {
          const box = await card.boundingBox();
          return box && (at.x < box.x || at.x > box.x + box.width || at.y < box.y || at.y > box.y + box.height);
        });
        await card.getByRole('button', {name: 'Close'}).click();
      }
    await leave(page);
  }
  const page = await person();
  await open(page);
  await page.locator('dt:text-is("On the map")').waitFor();
  await page.getByRole('button', {name: 'Follow'}).click();
  const canvas = await page.locator('canvas').boundingBox();
  await page.mouse.click(canvas.x + canvas.width / 2, canvas.y + canvas.height / 2);  // where the robot is
  const question = page.getByText("Set the robot's position here?"), yes = page.getByRole('button', {name: 'Yes', exact: true});
  assert.equal(await yes.count(), 0);
  await page.getByRole('button', {name: 'The robot is here'}).click();
  await question.waitFor();
  await page.getByRole('button', {name: 'No', exact: true}).click();
  await question.waitFor({state: 'detached'});
  await page.getByRole('button', {name: 'The robot is here'}).click();
  await yes.click();
  await page.getByRole('dialog').waitFor({state: 'detached'});
  await leave(page);
});

test('a zone is drawn on the map, refuses goals there, is removed and undone; a point outside of the building has no route', async () => {
  const page = await person();
  await open(page);
  await page.locator('dt:text-is("On the map")').waitFor();
  await page.getByRole('button', {name: 'All', exact: true}).click();
  const canvas = await page.locator('canvas').boundingBox(), card = page.getByRole('dialog');
  const middle = [canvas.x + canvas.width / 2, canvas.y + canvas.height / 2];
  const zones = () => page.evaluate(() => saphira.data('map').artifacts.filter(a => a.type === 'ARTIFACT_ZONE'));
  const red = async () => (await colorsOf(page)).get('#d32f2f') ?? 0;
  await page.mouse.click(...middle);
  await card.getByRole('button', {name: 'Zone …'}).click();
  await page.mouse.move(middle[0] - 60, middle[1] - 40);
  await page.mouse.down();
  await page.mouse.move(middle[0] + 60, middle[1] + 40, {steps: 5});
  await page.mouse.up();
  await card.getByLabel('Name of the zone').fill('wet floor');
  await card.getByRole('button', {name: 'Add', exact: true}).click();
  await card.getByText('The zone is on the map.').waitFor();
  const [zone] = await until('the zone', async () => (await zones()).length === 1 && zones());
  assert.deepEqual([zone.rule, zone.name, Math.abs(zone.length / zone.width - 1.5) < 0.1], ['ZONE_KEEP_OUT', 'wet floor', true]);
  await until('its edge', red);
  await page.mouse.click(middle[0], middle[1] + 10);
  await card.getByRole('button', {name: 'Go here'}).click();
  await card.getByText(/ on the map is in keep-out zone "wet floor"/).waitFor();
  await card.getByRole('button', {name: 'Remove'}).click();
  await until('no zone', async () => (await zones()).length === 0);
  await card.getByRole('button', {name: 'Undo removing keep-out zone wet floor'}).click();
  await until('the zone', async () => (await zones()).length === 1);
  await card.getByRole('button', {name: 'Undo adding keep-out zone wet floor'}).click();
  await until('no zone', async () => (await zones()).length === 0);
  await card.getByRole('button', {name: 'Close'}).click();
  await page.mouse.click(canvas.x + 5, middle[1]);
  await card.getByRole('button', {name: 'Go here'}).click();
  await card.getByText(/ on the map is in no room or corridor of the map/).waitFor();
  // A goal with a heading, drawn upwards.
  await page.mouse.click(...middle);
  await card.getByRole('button', {name: 'Facing …'}).click();
  await page.mouse.move(...middle);
  await page.mouse.down();
  await page.mouse.move(middle[0], middle[1] - 80, {steps: 5});
  await page.mouse.up();
  await card.getByRole('button', {name: 'Go here'}).click();
  const facing = await until('the goal', () => page.evaluate(() =>
    saphira.all('goals').flatMap(([, {data}]) => data.arguments).find(a => a.name === 'facing')?.number));
  assert.ok(Math.abs(facing - Math.PI / 2) < 0.02, `${facing}`);
  await endAll(page);
  await leave(page);
});

test('a behavior that is edited while it runs is seen; a broken version changes nothing and says where', async () => {
  const shipped = readFileSync(join(process.env.SAPHIRA_SOURCE_DIR, 'config/behaviors/constant-velocity.beh'), 'utf8');
  const edit = text => writeFileSync(join(folder, 'constant-velocity.beh'), text);
  const page = await person();
  await open(page);
  await send(page, 'drive 0.05');
  await page.getByRole('tab', {name: 'Behaviors'}).click();
  await page.getByRole('button', {name: 'ConstantVelocity'}).click();
  const rule = name => page.locator('.rule', {hasText: name}).waitFor();
  await rule('go');
  edit(shipped.replace('go If', 'creep If'));
  await rule('creep');
  edit(shipped.replace('go If', 'go Iff'));
  await page.getByRole('tab', {name: 'Messages'}).click();
  await page.getByLabel('everything that programs log').check();
  await page.locator('.lines li', {hasText: 'constant-velocity.beh:7:'}).first().waitFor();
  await page.getByRole('tab', {name: 'Behaviors'}).click();
  await page.getByRole('button', {name: 'ConstantVelocity'}).click();
  await rule('creep');
  rmSync(join(folder, 'constant-velocity.beh'));
  await rule('go');
  await page.getByRole('tab', {name: 'Goals'}).click();
  await endAll(page);
  await leave(page);
});

test('a behavior is switched off and on', async () => {
  const page = await person();
  await open(page);
  await send(page, 'drive 0.1');
  await moves(page);
  await page.getByRole('tab', {name: 'Behaviors'}).click();
  const row = page.locator('.behaviors tr', {hasText: 'ConstantVelocity'}), on = page.getByRole('switch', {name: 'ConstantVelocity on'});
  await on.click();
  await row.getByText('off: it is left out').waitFor();
  assert.equal(await on.isChecked(), false);
  await stands(page);
  await on.click();
  await moves(page);
  assert.equal(await on.isChecked(), true);
  await page.getByRole('tab', {name: 'Goals'}).click();
  await endAll(page);
  await leave(page);
});

test('the history of the link', async () => {
  const page = await person({bypassCSP: true});
  await open(page);
  await page.locator('.link.live').click();
  const history = page.getByRole('region', {name: 'The link over the last minutes'});
  for (const [name, value] of [['Age of the picture', /\d ms, at most/], ['There and back', /\d ms, at most/], ["The robot's own packets a second", /: \d+, at most/]])
    await until(name, async () => value.test(await history.getByRole('img', {name}).getAttribute('aria-label')));
  assert.ok((await history.locator('.chart-bars').first().getAttribute('d')).startsWith('M'));
  await page.addScriptTag({content: axeSource});
  assert.deepEqual((await page.evaluate(() => window.axe.run())).violations.map(v => v.id), []);
  await history.getByRole('button').click();
  await history.waitFor({state: 'detached'});
  await leave(page);
});

test('a micro-task is held and let go on; drawings and messages of a program, and what a person says, are shown', async t => {
  const page = await person();
  await open(page);
  const magenta = async () => (await colorsOf(page)).get('#ff00ff') ?? 0;
  const drawing = {source: 'test', frame: 'FRAME_ROBOT', shape: 'DRAWING_LINE', points: [{x: 0.5, y: -0.5}, {x: 0.5, y: 0.5}],
    red: 255, blue: 255, width: 0.2};
  const draws = start('saphira', '--robot', robot, 'write', 'drawings', JSON.stringify(drawing));
  const tells = start('saphira', '--robot', robot, 'write', 'messages', '-');
  t.after(() => [draws, tells].map(end));
  await until('the drawing', magenta);
  await page.getByText('Layers').click();
  await page.getByLabel('drawings of programs').uncheck();
  await until('no drawing', async () => await magenta() === 0);
  await page.getByLabel('drawings of programs').check();
  await until('the drawing again', magenta);
  await end(draws);
  await until('its end', async () => await magenta() === 0);

  await page.getByRole('tab', {name: 'Messages'}).click();
  await page.getByLabel('Say something to the robot').fill('good morning');
  await page.getByRole('button', {name: 'Say'}).click();
  await page.locator('.lines li', {hasText: 'good morning'}).first().waitFor();
  // Until it is heard: the console may not have found the writer yet.
  await until('the message', async () => {
    tells.stdin.write('{"source":"test","text":"dinner is ready"}\n');
    await sleep(100);
    return page.locator('.lines li', {hasText: 'test dinner is ready'}).count();
  });

  await page.getByRole('tab', {name: 'Programs'}).click();
  await page.locator('summary', {hasText: 'interpretation'}).click();
  const task = page.locator('.processes li', {hasText: 'occgrid'});
  await task.getByRole('button', {name: 'Interrupt occgrid'}).click();
  await task.locator('.chip', {hasText: 'suspended'}).waitFor();
  await task.getByRole('button', {name: 'Resume occgrid'}).click();
  await task.locator('.chip', {hasText: 'running'}).waitFor();
  await leave(page);
});

test('a goal that needs an approval begins when a person gives it', async t => {
  const [page, watcher] = [await person(), await person()];
  await page.goto(address);
  await watcher.goto(address.replace(/#.*/, ''));
  const asks = start('saphira', '--robot', robot, 'goal', 'turn', 'to', '0');
  t.after(() => end(asks));
  const goal = page.locator('li.card', {hasText: 'turn to'}).first();
  await goal.getByText(/waits for a person's approval/).waitFor();
  await watcher.getByText(/waits for a person's approval/).first().waitFor();
  assert.equal(await watcher.getByRole('button', {name: /^Approve/}).count(), 0);
  await goal.getByRole('button', {name: /^Approve/}).click();
  await until('its end', () => asks.exitCode !== null);
  assert.equal(asks.exitCode, 0);
  for (const each of [page, watcher]) await leave(each);
});

test('reload and the back button keep the key', async () => {
  const page = await person();
  await open(page);
  await page.reload();
  await page.locator('.link.live').waitFor();
  await page.goto('about:blank');
  await page.goBack();
  await page.locator('.link.live').waitFor();
  await page.getByRole('button', {name: 'Drive', exact: true}).waitFor();
  await leave(page);
});

test('the map is saved as a file, and loaded; a bad file changes nothing and says where', async () => {
  const page = await person();
  await open(page);
  await page.getByText('Layers').click();
  const [file] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', {name: 'Save the map'}).click()]);
  assert.equal(file.suggestedFilename(), 'office.map');
  const saved = join(folder, 'saved.map');
  await file.saveAs(saved);
  const text = readFileSync(saved, 'utf8'), lines = text.trim().split('\n').length, map = () => page.evaluate(() => saphira.data('map'));
  const before = await map();
  assert.equal(before.artifacts.length, lines);
  const choose = (name, content) => page.getByLabel('Load a map').setInputFiles({name, mimeType: 'text/plain', buffer: Buffer.from(content)});
  await choose('bad.map', text.replace(/^(.*\n)/, '$1WALL 1, x, 3, 4\n'));
  await page.locator('.note.bad', {hasText: /bad\.map:2:9: .*The map stays as it was/}).waitFor();
  assert.deepEqual(await map(), before);
  // Without the end of its last line it may be cut off.
  await choose('cut.map', text.trimEnd().slice(0, -1));
  await page.locator('.note.bad', {hasText: 'cut.map'}).waitFor();
  await choose('more.map', `${text}POS (901) 1000, 1000, 0 "new place"\n`);
  await until('the other map', async () => (await map()).artifacts.some(a => a.name === 'new place'));
  assert.equal((await map()).source, 'more.map');
  await choose('office.map', text);
  await until('the first map', async () => (await map()).source === 'office.map');
  assert.equal((await map()).artifacts.length, before.artifacts.length);
  await leave(page);
});

// Last: it loads another world.
test('the simulator is paused, stepped, rearranged and given another world, and the robot is not told', async () => {
  const page = await person(), stranger = await person(), watcher = await person();
  await open(watcher);
  await page.goto(address.replace('/#', '/simulator.html#'));
  const at = async () => (await page.getByText(/^x .* m, y .* m/).innerText()).match(/x (\S+) m, y (\S+) m/).slice(1).map(Number);
  await page.locator('.chip.good', {hasText: 'runs'}).waitFor();
  const looked = await person({bypassCSP: true});
  await looked.goto(address.replace('/#', '/simulator.html#'));
  await looked.locator('.chip.good', {hasText: 'runs'}).waitFor();
  await looked.addScriptTag({content: axeSource});
  const {violations} = await looked.evaluate(() => window.axe.run());
  await leave(looked);
  assert.deepEqual(violations.map(v => `${v.id}: ${v.nodes.map(n => n.html).join(' ')}`), []);

  const epoch = () => watcher.evaluate(() => saphira.data('robot/state').stamp.epoch), connection = await epoch();
  await page.getByRole('button', {name: 'Pause'}).click();
  await page.locator('.chip', {hasText: 'paused'}).waitFor();
  // A robot that says nothing: the picture of it is marked as old.
  await watcher.locator('.link.old').waitFor();
  await watcher.locator('canvas.stale').waitFor();
  await watcher.getByText(/The picture is [3-9]\.\d s old. The robot says nothing./).waitFor();
  const time = async () => parseFloat(await fact(page, 'Time'));
  const before = await time();
  await page.getByRole('button', {name: 'Step 0.1 s'}).click();
  await until('a step', async () => Math.abs(await time() - before - 0.1) < 0.01);
  await page.getByRole('button', {name: 'Go on'}).click();
  await until('time', async () => await time() > before + 0.5);
  await watcher.locator('.link.live').waitFor();
  assert.equal(await epoch(), connection);

  const [x, y] = await at();
  await page.getByRole('button', {name: 'Move it right'}).click();
  await until('the robot is moved', async () => Math.abs((await at())[0] - x - 0.1) < 0.02);
  // By hand: it is picked up where it is drawn, and put down elsewhere.
  const canvas = await page.locator('canvas').boundingBox();
  const scale = 0.95 * Math.min(canvas.width / 24, canvas.height / 14);
  const pixel = (wx, wy) => [canvas.x + (canvas.width - 24 * scale) / 2 + wx * scale, canvas.y + (canvas.height + 14 * scale) / 2 - wy * scale];
  await page.mouse.move(...pixel(x + 0.1, y));
  await page.mouse.down();
  await page.mouse.move(...pixel(x + 1, y), {steps: 5});
  await page.mouse.up();
  await until('the robot is carried', async () => Math.abs((await at())[0] - x - 1) < 0.15);
  // The picture: a pixel's colour tells where the robot is drawn.
  const drawnAt = (px, py) => page.evaluate(([px, py]) => {
    const canvas = document.querySelector('canvas'), ratio = canvas.width / canvas.clientWidth;
    const [r, g, b] = canvas.getContext('2d').getImageData((px - canvas.getBoundingClientRect().x) * ratio, (py - canvas.getBoundingClientRect().y) * ratio, 1, 1).data;
    return `#${[r, g, b].map(c => c.toString(16).padStart(2, '0')).join('')}`;
  }, [px, py]);
  const robotColor = await page.evaluate(() => getComputedStyle(document.documentElement).getPropertyValue('--map-robot').trim());
  const middle = [canvas.x + canvas.width / 2, canvas.y + canvas.height / 2];
  // Beside the line of its heading.
  const inTheMiddle = async () => [await drawnAt(middle[0] + 4, middle[1] + 4), await drawnAt(middle[0] - 4, middle[1] - 4), await drawnAt(middle[0] + 4, middle[1] - 4)].includes(robotColor);
  await page.locator('canvas').focus();
  for (let i = 0; i < 4; ++i) await page.keyboard.press('+');
  assert.equal(await inTheMiddle(), false);
  await page.getByRole('button', {name: 'Recenter'}).click();
  await until('the robot in the middle', inTheMiddle);
  await page.getByRole('button', {name: 'Follow'}).click();
  await page.getByRole('button', {name: 'Follow', pressed: true}).waitFor();
  await page.mouse.click(middle[0] + canvas.width / 2 - 5, middle[1], {button: 'middle'});   // the robot is at the other edge
  await until('the picture follows the robot', inTheMiddle);
  await page.getByRole('button', {name: 'All'}).click();
  await page.getByRole('button', {name: 'Follow', pressed: false}).waitFor();
  await until('all of the world', async () => !await inTheMiddle());

  await page.getByText('Inputs and outputs').click();
  await page.getByLabel('Input pin 2').click();
  await page.getByLabel('Analog').fill('51');
  await page.getByText('1.00 V').waitFor();
  await until('the pin', () => page.getByLabel('Input pin 2').isChecked());

  await page.getByRole('button', {name: 'Disconnect'}).click();
  await watcher.locator('.link.live').waitFor();  // the bridge connects again by itself

  await stranger.goto(address.replace(/\/#.*/, '/simulator.html'));
  await stranger.getByText('Without the key you may watch').waitFor();
  assert.equal(await stranger.getByRole('button', {name: 'Pause'}).isDisabled(), true);

  const worlds = page.locator('label', {hasText: /^World/}).locator('select');
  // The list is read anew when it is opened.
  await page.evaluate(() => {
    const send = WebSocket.prototype.send;
    window.sent = [];
    WebSocket.prototype.send = function (data) {
      window.sent.push(data);
      this.addEventListener('message', event => { if (JSON.parse(event.data).type === 'files') window.files = event.data; });
      return send.call(this, data);
    };
  });
  await worlds.focus();
  const files = await until('the list of worlds', () => page.evaluate(() => window.files));
  assert.deepEqual(await page.evaluate(() => window.sent), ['{"do":"files"}']);
  assert.ok(JSON.parse(files).worlds.includes('arena'));
  await worlds.selectOption('arena');
  await page.getByRole('button', {name: 'Load'}).click();
  await until('another world', async () => await worlds.inputValue() === 'arena' && (await at())[0] < 11);
  await watcher.locator('.link.live').waitFor();
  for (const each of [page, stranger, watcher]) await leave(each);
});
