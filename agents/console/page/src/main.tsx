import {render} from 'preact';
import {App} from './app';

const app = document.getElementById('app')!;
app.replaceChildren();
render(<App />, app);
