import { WebGLRenderer } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

const data = JSON.parse(document.getElementById('emax-data').textContent);
document.getElementById('title').textContent = data.title;
document.title = `${data.title}: emax report`;
void [WebGLRenderer, OrbitControls];
