// The hold of hands after events: exact, without a browser. `npm test`
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {test} from 'node:test';
import {transformSync} from 'esbuild';

const {code} = transformSync(readFileSync(new URL('../src/hands.ts', import.meta.url)), {loader: 'ts'});
const {Hands, period} = await import(`data:text/javascript,${encodeURIComponent(code)}`);

const acts = ['faster', 'slower', 'left', 'right', 'keep'];
const mapped = {standard: 'Some pad (Vendor: 1)', joystick: 'Test Joystick (Vendor: 2)', unknown: 'Test device (Vendor: 3)', generic: 'Generic USB Joystick'};

// Plays words such as 'down KeyI ctrl', and returns what is held then.
function play(steps) {
  const hands = new Hands(), pads = [];
  let now = 1000, may = true, by = '', act = '';
  const sample = () => { by = hands.sample(now, pads.filter(p => p), may); };
  const wait = time => {
    for (const end = now + time; now < end; sample()) now = Math.min(end, now + period);
  };
  const key = (place, more, repeat) => {
    act = hands.press({code: place === '-' ? '' : place, key: more.find(m => m.length === 1) ?? '', repeat, shortcut: more.includes('ctrl'), own: more.includes('own'), may: may && !more.includes('early')}, now);
  };
  sample();
  for (const step of steps.split(', ')) {
    const [what, name, ...more] = step.split(' ');
    if (what === 'down') key(name, more, false);
    else if (what === 'repeat') key(name, more, true);
    else if (what === 'up') hands.release(name === '-' ? '' : name, now);
    else if (what === 'repeats') {   // after a delay, `count` of them with a gap
      const [delay, gap, count] = more.map(Number);
      for (let i = 0; i < count; ++i) {
        wait(i ? gap : delay);
        key(name, [], true);
      }
    } else if (what === 'wait') wait(Number(name));
    else if (what === 'stall') now += Number(name);
    else if (what === 'touch') hands.grasp(Number(name), {x: 0, y: 1});
    else if (what === 'move') hands.move(Number(name), {x: 0, y: -1}, more[0] !== 'loose');
    else if (what === 'lift') hands.drop(Number(name));
    else if (what === 'doubt') hands.letGo('a doubt');
    else if (what === 'control') may = name === 'on';
    else if (what === 'pad') {   // a kind, and the buttons that are pressed
      pads[name] = {index: Number(name), id: mapped[more[0]], mapping: more[0] === 'standard' ? 'standard' : '', timestamp: now, axes: [0, -1],
                    buttons: Array.from({length: 16}, (_, i) => ({pressed: more.slice(1).includes(String(i))}))};
    } else if (what === 'unplug') pads[name] = undefined;
    else assert.fail(step);
    sample();
  }
  const held = by === 'key' ? acts.filter(a => hands.holds(a)).join(' ') : by && `${by} ${hands.at.x} ${hands.at.y}`.replace('-0 ', '0 ');
  return {held, act, doubt: hands.doubt, padHint: hands.padHint, pad: hands.pad};
}

const gone = 'the keyboard no longer says that the key is held', shortcut = 'Ctrl, Alt or Meta was pressed';
// What is held after the steps, and why nothing is.
const table = [
  // Presses and releases.
  ['down KeyI', 'faster'],
  ['down KeyI, up KeyI', ''],
  ['down KeyI, down KeyJ', 'faster left'],
  ['down KeyI, down KeyJ, up KeyI', 'left'],
  ['down ArrowUp, down KeyI, up KeyI', 'faster'],
  ['repeat KeyI', ''],
  ['down KeyI, up KeyI, repeat KeyI', ''],
  ['down KeyX', ''],
  // By the place, whatever letter it has.
  ['down KeyI ш', 'faster'],
  ['down KeyI ш, up KeyI', ''],
  ['down KeyI Ι, down KeyL Λ', 'faster right'],
  ['down KeyG i', ''],   // Dvorak
  ['down - i', ''],
  // A release counts with a modifier, and in a field.
  ['down KeyI, down ControlLeft ctrl, up KeyI', '', shortcut],
  ['down KeyI, down ShiftLeft, up KeyI, up ShiftLeft', ''],
  ['down KeyI, down ShiftLeft', 'faster'],
  // A shortcut may take the release.
  ['down KeyI, down MetaLeft ctrl', '', shortcut],
  ['down KeyI, down KeyR ctrl', '', shortcut],
  ['down KeyI ctrl', ''],
  ['down KeyI, down AltRight ctrl, up AltRight, repeat KeyI', '', shortcut],
  ['down KeyI, down AltRight ctrl, up AltRight, up KeyI, down KeyI', 'faster'],
  ['down KeyI, down ControlLeft ctrl, up ControlLeft, down KeyM, up KeyI', 'slower'],
  // Keys of fields are theirs.
  ['down KeyI own', ''],
  ['down KeyI own, repeat KeyI', ''],
  // In doubt.
  ['down KeyI, doubt', '', 'a doubt'],
  ['down KeyI, doubt, repeat KeyI, wait 100', '', 'a doubt'],
  ['down KeyI, doubt, up KeyI, down KeyI', 'faster'],
  ['down KeyI, doubt, down KeyI', 'faster'],   // its release was not heard
  ['down KeyI, up PageUp', '', 'a key was let go whose press was not seen'],   // Fn
  ['down KeyI, up -', '', 'a key was let go whose press was not seen'],
  ['up Enter, down KeyI', 'faster'],
  ['down KeyX, down KeyI, up KeyX', 'faster'],
  ['down KeyI, wait 350', 'faster'],
  ['down KeyI, stall 401', '', 'this page stood still for a moment'],
  ['down KeyI, stall 400', 'faster'],
  ['touch 1, stall 500', '', 'this page stood still for a moment'],
  // Without control.
  ['control off, down KeyI', ''],
  ['down KeyI early', ''],   // control comes after it
  ['control off, down KeyI, control on, repeat KeyI', ''],
  ['down KeyI, control off, control on', ''],
  ['control off, pad 0 standard 4, control on, wait 100', ''],
  // Repeats: a key that repeated and no more is not held.
  ['down KeyI, wait 9900', 'faster'],
  ['down KeyI, wait 10100', '', gone],
  ['down KeyI, repeats KeyI 500 33 20', 'faster'],
  ['down KeyI, repeats KeyI 500 33 20, wait 200', 'faster'],
  ['down KeyI, repeats KeyI 500 33 20, wait 250', '', gone],
  ['down KeyI, repeats KeyI 500 33 20, wait 300, repeat KeyI', '', gone],
  ['down KeyI, repeats KeyI 500 33 20, wait 300, up KeyI, down KeyI', 'faster'],
  ['down KeyI, repeats KeyI 1000 500 9', 'faster'],                    // the slowest keyboards
  ['down KeyI, repeats KeyI 1000 500 9, wait 1450', 'faster'],
  ['down KeyI, repeats KeyI 1000 500 9, wait 1600', '', gone],
  ['down KeyI, repeats KeyI 500 33 20, stall 390, wait 50', 'faster'],   // events wait behind the sample
  // It has repeated before, so it repeats again.
  ['down KeyI, repeats KeyI 500 33 5, up KeyI, down KeyI, wait 950', 'faster'],
  ['down KeyI, repeats KeyI 500 33 5, up KeyI, down KeyI, wait 1000', '', gone],
  ['down KeyI, repeats KeyI 500 33 5, up KeyI, down KeyM, wait 5000', 'slower'],
  // Once, on a keyboard that has stopped repeating.
  ['down KeyI, repeats KeyI 500 33 5, up KeyI, down KeyI, wait 1050, up KeyI, down KeyI, wait 5000', 'faster'],
  // Only the key that was pressed last repeats.
  ['down KeyI, repeats KeyI 500 33 20, down KeyJ, wait 5000', 'faster left'],
  ['down KeyI, repeats KeyI 500 33 20, down KeyJ, up KeyJ, wait 5000', 'faster'],
  ['down KeyJ, down KeyI, repeats KeyI 500 33 20, up KeyJ, wait 5000', 'faster'],
  ['down KeyI, repeats KeyI 500 33 20, down ShiftLeft, wait 5000', 'faster'],
  ['down KeyI, repeats KeyI 500 33 20, down ShiftLeft, up ShiftLeft, repeats KeyI 20 33 20, wait 300', '', gone],
  ['down KeyI, down KeyJ, up KeyJ, wait 10100', '', gone],
  ['down KeyI, down ShiftLeft, up ShiftLeft, repeats KeyI 20 33 3, up KeyI, down KeyI, wait 900', 'faster'],   // no first repeat was seen
  // One pointer holds the stick.
  ['touch 1', 'stick 0 1'],
  ['touch 1, move 1', 'stick 0 -1'],
  ['touch 1, lift 1', ''],
  ['touch 1, lift 1, move 1', ''],
  ['touch 1, move 1 loose', ''],   // its release was not heard
  ['touch 1, touch 2, move 2', 'stick 0 1'],
  ['touch 1, touch 2, lift 2', 'stick 0 1'],
  ['touch 1, touch 2, lift 1', ''],
  ['touch 1, doubt, move 1', '', 'a doubt'],
  ['touch 1, doubt, touch 2', 'stick 0 1'],
  ['down KeyI, touch 1, lift 1', 'faster'],
  // Gamepads.
  ['pad 0 standard, wait 50, pad 0 standard 4', 'gamepad 0 1'],
  ['pad 0 standard, wait 50, pad 0 standard 7', 'gamepad 0 1'],
  ['pad 0 standard, wait 50, pad 0 standard 0 1 2 3 8 15', ''],
  ['pad 0 joystick, wait 50, pad 0 joystick 0', 'gamepad 0 1'],
  ['pad 0 joystick, wait 50, pad 0 joystick 1 4 5', ''],
  ['pad 0 unknown, wait 50, pad 0 unknown 0 1 2 3 4 5 6 7', ''],
  ['pad 0 generic, wait 50, pad 0 generic 0 4', ''],
  ['pad 0 standard 4, wait 50', ''],   // held when it was found
  ['pad 0 standard, wait 50, pad 0 standard 4, pad 0 standard', ''],
  ['pad 0 standard, wait 50, pad 0 standard 4, unplug 0', ''],
  ['pad 0 standard, wait 50, pad 0 standard 4, unplug 0, pad 0 standard 4', ''],
  ['pad 0 standard, wait 50, pad 0 standard 4, doubt, wait 100', '', 'a doubt'],
  ['pad 0 standard, wait 50, pad 0 standard 4, doubt, pad 0 standard, pad 0 standard 4', 'gamepad 0 1'],
  ['pad 0 standard, wait 50, pad 0 standard 4, wait 4950', 'gamepad 0 1'],
  ['pad 0 standard, wait 50, pad 0 standard 4, wait 5050', ''],   // out of reach
  ['pad 0 standard, wait 50, pad 0 standard 4, wait 5050, pad 0 standard 4', 'gamepad 0 1'],
  // Another one takes over only once nothing is held on it.
  ['pad 0 standard, pad 1 standard, pad 1 standard 4, pad 0 standard 4, unplug 1, wait 50', ''],
  ['pad 0 standard, pad 1 standard, pad 1 standard 4, pad 0 standard 4, pad 1 standard, wait 50', ''],
  ['pad 0 standard, pad 1 standard, pad 1 standard 4, pad 0 standard 4, unplug 1, pad 0 standard, pad 0 standard 4', 'gamepad 0 1'],
  ['pad 0 standard, pad 1 standard, pad 2 joystick, pad 2 joystick 0', 'gamepad 0 1'],
];
for (const [steps, held, doubt = ''] of table)
  test(`${steps}: ${held || 'nothing'}`, () => {
    const end = play(steps);
    assert.deepEqual({held: end.held, doubt: end.doubt}, {held, doubt});
  });

test('a stick that is gone from the page is not held', () => {
  const hands = new Hands();
  let there = true;
  hands.sample(0, [], true);
  hands.grasp(1, {x: 0, y: 1}, () => there);
  assert.equal(hands.sample(50, [], true), 'stick');
  there = false;
  assert.equal(hands.sample(100, [], true), '');
});

test('the stop is at its place, and at its letter', () => {
  for (const [step, act] of [['down KeyK', 'stop'], ['down KeyK л', 'stop'], ['down KeyK t', 'stop'], ['down KeyV k', 'stop'], ['down Space', 'stop'],
                             ['down - k', 'stop'], ['repeat KeyK', 'stop'], ['control off, down KeyK', 'stop'], ['down KeyJ k', 'left'],
                             ['down KeyK own', ''], ['down KeyK ctrl', ''], ['down KeyG п', 'constant'], ['down KeyC', 'guard'], ['down KeyX', '']])
    assert.equal(play(step).act, act, step);
});

test('a gamepad says which button is meant, or that it does not drive', () => {
  for (const [steps, hint] of [
    ['wait 50', ''],
    ['pad 0 standard', 'hold a shoulder button to drive'],
    ['pad 0 joystick', 'hold the trigger, its first button, to drive'],
    ['pad 0 unknown, pad 1 joystick', 'hold the trigger, its first button, to drive'],
    ['pad 0 unknown', 'its buttons have no names here, so it does not drive; the command saphira drive knows more of them'],
    ['pad 0 standard, wait 50, pad 0 standard 4', ''],
    ['pad 0 standard 4', 'let go of all gamepads first'],
    ['pad 0 standard, wait 50, pad 0 standard 4, wait 5050', 'it says nothing; move its stick, or press its button again'],
  ]) assert.equal(play(steps).padHint, hint, steps);
});
