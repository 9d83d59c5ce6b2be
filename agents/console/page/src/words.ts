// Words that several parts of the page use.
export const keyless = 'needs the key: open the address that the console has printed';
export const driverWords: {[role: string]: string} = {
  ROLE_NONE: 'nobody drives', ROLE_TELEOP: 'a person drives', ROLE_DIRECT: 'a program drives',
  ROLE_BEHAVIORS: 'autonomy drives', ROLE_ESTOP: 'emergency stop',
};
// Of a text of the other programs: commands that have a button here go by its name.
export function forPage(text: string): string {
  return text.replace(/saphira estop reset/g, 'Reset').replace(/saphira drive hand-back/g, 'Hand back')
    .replace(/saphira status/g, 'Programs').replace(/saphira goal list/g, 'Goals')
    .replace(/saphira goal activities/g, 'the field in Goals').replace(/saphira map show/g, 'the map shows them')
    .replace(/saphira map place X Y (TH|HEADING)(, or saphira map find)?/g, 'click where it is: The robot is here …');
}
export const old = 1000;     // [ms] of a picture or a sentence: from then on its age is said
export const seconds = (ms: number) => `${(ms / 1000).toFixed(ms < 10_000 ? 1 : 0)} s`;
export const percent = (value: number) => `${Math.round(100 * Math.min(1, Math.max(0, value)))}%`;
const two = (n: number) => String(n).padStart(2, '0');
// [ms since 1970] as HH:MM:SS, here.
export function clock(time: number): string {
  const at = new Date(time);
  return `${two(at.getHours())}:${two(at.getMinutes())}:${two(at.getSeconds())}`;
}

// The name of an activity's behavior ends with the number of its instance: rest#32.
export function instanceWords(name: string): string {
  return name.replace(/^(.+)#(\d+)$/, '$1, instance $2');
}
